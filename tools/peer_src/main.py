"""tools/peer: this renderer beside Mitsuba 3, one thread each, in turns."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def fail(message, code=2):
    print(f"tools/peer: error: {message}", file=sys.stderr)
    sys.exit(code)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="tools/peer", description=__doc__)
    parser.add_argument("scene", metavar="SCENE.xml")
    parser.add_argument("--spp", default="16,64,256", help="samples a pixel, comma-separated [%(default)s]")
    parser.add_argument("--seeds", type=int, default=5, help="runs of each [%(default)s]")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba [%(default)s]")
    parser.add_argument("--sampler", default="multijitter", help="of Mitsuba [%(default)s]")
    parser.add_argument("--reuse", default="1", choices=("1", "2", "4"),
                        help="pixels a side of our blocks that share paths [%(default)s]")
    parser.add_argument("--reference", metavar="FILE", help="converged picture, PFM; else both renderers' mean")
    parser.add_argument("--reference-spp", type=int, default=4096, help="without --reference [%(default)s]")
    parser.add_argument("--renderer", default=os.path.join(ROOT, "build", "bin", "renderer"))
    parser.add_argument("--json", metavar="FILE", help="also write the numbers")
    options = parser.parse_args(arguments)
    try:
        options.spp = [int(s) for s in options.spp.split(",")]
    except ValueError:
        parser.error(f"--spp: not a list of counts (got '{options.spp}')")
    if min(options.spp + [options.reference_spp]) < 1 or options.seeds < 2:
        parser.error("--spp and --reference-spp must be at least 1, --seeds at least 2")
    if not os.path.isfile(options.scene):
        fail(f"cannot read {options.scene}", 3)
    return options


class Plumbline:
    name = "plumbline"

    def __init__(self, options):
        self.program, self.scene, self.reuse = options.renderer, options.scene, options.reuse

    def render(self, spp, seed):
        """Picture and seconds of rendering. By a PFM: Mitsuba's own reader stands still on one core."""
        from chart_src.measure import read_pfm
        with tempfile.TemporaryDirectory() as folder:
            picture, stats = os.path.join(folder, "a.pfm"), os.path.join(folder, "a.json")
            subprocess.run([self.program, "-q", "--threads", "1", "--sampler", "sobol", "--reuse", self.reuse,
                            "--spp", str(spp), "--seed", str(seed), "--stats", stats, "-o", picture, self.scene], check=True)
            with open(stats, encoding="utf-8") as file:
                return read_pfm(picture), json.load(file)["render_s"]


class Mitsuba:
    name = "mitsuba"

    def __init__(self, mi, dr, np, options):
        self.dr, self.np, self.mi = dr, np, mi
        dr.set_thread_count(1)
        with open(options.scene, encoding="utf-8") as file:
            text = file.read()
        text = re.sub(r'(<sampler\s+type=)"[^"]*"', rf'\1"{options.sampler}"', text)
        mi.file_resolver().append(os.path.dirname(os.path.abspath(options.scene)))
        self.scene = mi.load_string(text)
        for spp in options.spp:
            self.render(spp, 0)  # compiles

    def render(self, spp, seed):
        begin = time.perf_counter()
        picture = self.mi.render(self.scene, spp=spp, seed=seed)
        self.dr.eval(picture)
        self.dr.sync_thread()
        seconds = time.perf_counter() - begin
        return self.np.array(picture, dtype=self.np.float64)[..., :3], seconds


def measure(renderers, options):
    import efficiency
    from chart_src.measure import read_pfm
    share = 0.0
    if options.reference:
        reference = read_pfm(options.reference)
    else:
        halves = [r.render(options.reference_spp, 987654)[0] for r in renderers]
        reference, share = (halves[0] + halves[1]) / 2, efficiency.reference_share(*halves)
    rows = []
    for spp in options.spp:
        errors, seconds = {r.name: [] for r in renderers}, {r.name: [] for r in renderers}
        for seed in range(1, options.seeds + 1):
            for r in renderers:
                picture, took = r.render(spp, seed)
                if picture.shape != reference.shape:
                    fail(f"the reference has another size: {reference.shape}, not {picture.shape}", 4)
                errors[r.name].append(efficiency.relative_mse(picture, reference) - share)
                seconds[r.name].append(took)
        row = {"spp": spp, **{r.name: efficiency.summary(errors[r.name], seconds[r.name]) for r in renderers}}
        row["ratio"] = row["plumbline"]["efficiency"] / row["mitsuba"]["efficiency"]
        rows.append(row)
        print_row(row)
    return {"reference": "given" if options.reference else f"mean of both at {options.reference_spp} spp",
            "reference_relmse": share, "rows": rows}


def print_row(row):
    for name in ("plumbline", "mitsuba"):
        s = row[name]
        low, high = s["efficiency_95"]
        print(f"{row['spp']:>6} {name:<10} relMSE {s['relmse']:.3e}  {s['seconds']:8.3f} s  "
              f"E {s['efficiency']:6.1f} ({low:.1f} to {high:.1f})", flush=True)
    print(f"{'':>6} plumbline / mitsuba: {row['ratio']:.2f}", flush=True)


def main(arguments):
    options = parse(arguments)
    try:
        import numpy as np
        import mitsuba as mi
        import drjit as dr
    except ImportError as error:
        fail(f"{error.name} is not installed; tools/peer says how", 6)
    if options.variant not in mi.variants():
        fail(f"no such variant (got '{options.variant}', expected one of {', '.join(mi.variants())})")
    mi.set_variant(options.variant)

    result = measure([Plumbline(options), Mitsuba(mi, dr, np, options)], options)
    result = {"scene": os.path.basename(options.scene), "mitsuba": mi.__version__,
              "variant": options.variant, "sampler": options.sampler, "reuse": int(options.reuse), **result}
    if options.json:
        partial = options.json + ".part"
        with open(partial, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
            file.write("\n")
        os.replace(partial, options.json)


if __name__ == "__main__":
    sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)), os.path.join(ROOT, "tools")]
    main(sys.argv[1:])
