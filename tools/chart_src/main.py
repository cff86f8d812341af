"""tools/chart: options, the rounds of measurements, chart.json and the pictures."""
import argparse
import json
import os
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[0] = os.path.join(ROOT, "tools")

from chart_src import analysis, measure, methods, reference, report_svg  # noqa: E402

SCENES = ["cornell-box", "sphere-light", "many-lights"]


class Parser(argparse.ArgumentParser):
    def error(self, message):
        print(f"error: {message} (see --help)", file=sys.stderr)
        sys.exit(2)


def positive(kind):
    def parse(text):
        value = kind(text)
        if not 0 < value < 1e9:
            raise ValueError
        return value
    parse.__name__ = "positive number"
    return parse


def parse(arguments):
    p = Parser(prog="chart", description="Error against time of the renderer's methods.")
    p.add_argument("scenes", nargs="*", help="default: " + ", ".join(SCENES))
    p.add_argument("--methods", nargs="+", default=["*"], help="names with *, or KEY=VALUE+KEY=VALUE")
    p.add_argument("--time", type=positive(float), default=120, help="seconds for all measurements [120]")
    p.add_argument("--out", default="chart", help="folder that receives everything [chart]")
    p.add_argument("--seeds", type=positive(int), default=4, help="independent runs of each point [4]")
    p.add_argument("--max-spp", type=positive(int), default=1024)
    p.add_argument("--threads", type=positive(int), default=1)
    p.add_argument("--width", type=positive(int), default=96, help="pixels a side [96]")
    p.add_argument("--clock", choices=["wall", "cpu"], default="wall", help="cpu: for a busy machine")
    p.add_argument("--quick", action="store_true", help="48 pixels, 2 seeds, 16 spp, 20 s")
    p.add_argument("--renderer", default=os.path.join(ROOT, "build/bin/renderer"))
    p.add_argument("--cache", default=os.path.join(ROOT, "build/chart-references"))
    o = p.parse_args(arguments)
    if o.quick:
        o.width, o.seeds, o.max_spp, o.time = 48, min(o.seeds, 2), min(o.max_spp, 16), min(o.time, 20)
    try:
        o.chosen = methods.select(o.methods)
    except ValueError as error:
        p.error(f"--methods: {error}")
    o.scenes = o.scenes or [os.path.join(ROOT, "scenes", s + ".xml") for s in SCENES]
    return o


def measure_scene(scene, o, renderer, end, result):
    """Level by level, each method with all seeds if that fits before `end` (monotonic seconds);
    seeds outside, methods inside, so that a disturbance hits all alike."""
    ref = reference.make_reference(scene, renderer, o.cache, 0.25 * (end - time.monotonic()))
    result["reference"] = {"spp": ref.spp, "seconds": ref.seconds, "mse": float(ref.variance.mean())}
    took, spp = {}, 1
    while spp <= o.max_spp:
        fits, left = [], end - time.monotonic()
        for m in o.chosen:
            need = 2.2 * took.get((m.name, spp // 2), 0.0 if spp == 1 else 1e30)
            if need <= left:
                fits.append(m)
                left -= need
        for seed in range(o.seeds):
            for m in fits:
                if time.monotonic() >= end:
                    return
                measure.progress(f"{result['name']}: {m.name}, {spp} spp, seed {seed}")
                begun = time.monotonic()
                picture, record = renderer.render(scene, m, spp, seed)
                record["seconds"] = record[o.clock + "_s"]
                record.update(measure.errors_of(picture, ref))
                result["runs"].append(record)
                took[m.name, spp] = took.get((m.name, spp), 0) + time.monotonic() - begun
        if not fits:
            return
        spp *= 2


def write(path, text):
    """Whole or not at all."""
    part = f"{path}.{os.getpid()}.part"
    with open(part, "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(part, path)


def cpu_model():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown")


def main(arguments):
    o = parse(arguments)
    for scene in o.scenes:
        if not os.path.isfile(scene):
            print(f"{scene}: error: cannot open: no such file", file=sys.stderr)
            return 3
    try:
        os.makedirs(o.out, exist_ok=True)
        write(os.path.join(o.out, "chart.json"), "{}\n")
    except OSError as error:
        print(f"{o.out}: error: {error.strerror}", file=sys.stderr)
        return 5
    code, results, start = 0, [], time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        renderer = measure.Renderer(o.renderer, folder, o.threads, o.width)
        try:
            for i, scene in enumerate(o.scenes):
                name = os.path.splitext(os.path.basename(scene))[0]
                results.append({"name": name, "runs": []})
                end = start + o.time * (i + 1) / len(o.scenes)
                measure_scene(scene, o, renderer, end, results[-1])
        except KeyboardInterrupt:
            code = 130
        except measure.RenderError as error:
            print(error, file=sys.stderr)
            code = error.code
        measure.progress("")
        version = renderer.version()
    for r in results:
        r["summary"] = analysis.summary(r["runs"])
        if r["summary"]:
            write(os.path.join(o.out, r["name"] + ".svg"), report_svg.chart(r))
            print(analysis.text(r))
    table = {"renderer": version, "cpu": cpu_model(), "clock": o.clock, "width": o.width,
             "seeds": o.seeds, "complete": code == 0, "scenes": results,
             "methods": [{"name": m.name, "choices": m.choices} for m in o.chosen]}
    write(os.path.join(o.out, "chart.json"), json.dumps(table, indent=1) + "\n")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
