"""The command line of tools/chart."""
import argparse
import os
import sys

from chart_src import methods

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = ["cornell-box", "sphere-light", "many-lights"]
# What stands for an option that was not given: normally, with --quick.
DEFAULTS = {"time": (120.0, 20.0), "seeds": (4, 2), "max_spp": (1024, 16), "width": (96, 48)}


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print(f"chart: error: {message} (see --help)", file=sys.stderr)
        sys.exit(2)


def positive(kind):
    def parse(text):
        value = kind(text)
        if not 0 < value < 1e9:
            raise ValueError
        return value
    parse.__name__ = "positive number"
    return parse


def said(key):
    return "[{:g}, quick {:g}]".format(*DEFAULTS[key])


def parse(arguments):
    """Options, with the chosen methods and the scenes' paths; exits with 2 on a mistake."""
    p = Parser(prog="chart", allow_abbrev=False, description="Error against time of the renderer's methods.")
    p.add_argument("scenes", nargs="*", metavar="SCENE.xml", help="default: " + ", ".join(SCENES))
    p.add_argument("--methods", nargs="+", default=["*"], help="names, comma-separated, with * for any characters, or "
                   "KEY=VALUE+KEY=VALUE [all]")
    p.add_argument("--time", type=positive(float), metavar="S",
                   help="seconds for everything, shared evenly by the scenes; up to a quarter of a scene's "
                        "share makes its reference, which is kept for later runs " + said("time"))
    p.add_argument("--out", default="chart", metavar="FOLDER", help="receives everything [chart]")
    p.add_argument("--add", action="store_true", help="keep the other scenes that FOLDER has from an earlier run")
    p.add_argument("--seeds", type=positive(int), metavar="N", help="independent runs of each point " + said("seeds"))
    p.add_argument("--max-spp", type=positive(int), metavar="N", help="samples a pixel, at most " + said("max_spp"))
    p.add_argument("--threads", type=positive(int), default=1, metavar="N", help="of the renderer [1]")
    p.add_argument("--width", type=positive(int), metavar="N", help="pixels a side " + said("width"))
    p.add_argument("--clock", choices=["wall", "cpu"], default="wall", help="cpu: for a busy machine [wall]")
    p.add_argument("--quick", action="store_true", help="small values for what is not given")
    p.add_argument("-q", "--quiet", action="store_true", help="no progress")
    p.add_argument("--renderer", default=os.path.join(ROOT, "build/bin/renderer"), metavar="PROGRAM")
    p.add_argument("--cache", default=os.path.join(ROOT, "build/chart-references"), metavar="FOLDER",
                   help="keeps the references [build/chart-references]")
    p.add_argument("--bench", metavar="FILE", help="JSON of tools/bench: speeds for the second chart [the one in "
                   "tools/results with most accelerators]")
    p.add_argument("--stability", metavar="FILE", help="JSON of tools/stability: failures for it [tools/results]")
    o = p.parse_args(arguments)
    o.results = os.path.join(ROOT, "tools/results")
    for key, values in DEFAULTS.items():
        if getattr(o, key) is None:
            setattr(o, key, values[o.quick])
    try:
        o.chosen = methods.select([name for word in o.methods for name in word.split(",")])
    except ValueError as error:
        p.error(f"--methods: {error}")
    o.scenes = o.scenes or [os.path.join(ROOT, "scenes", s + ".xml") for s in SCENES]
    return o
