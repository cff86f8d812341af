"""tools/chart: the rounds of measurements, chart.json and the pictures.

Exit codes: 0 done, 2 usage, 3 scene, 4 results that cannot be read, 5 output, 6 no renderer, 128+n stopped by signal n (what was
measured is written), else the renderer's own.
"""
import functools
import json
import os
import signal
import sys
import tempfile
import time

sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

from chart_src import accelerators, analysis, measure, options, png, reference  # noqa: E402
from chart_src.accelerator_svg import accelerator_svg  # noqa: E402
from chart_src.error_svg import drawn, error_svg  # noqa: E402
from chart_src.page import page  # noqa: E402
from chart_src.progress import Progress  # noqa: E402
from page_src.files import write  # noqa: E402

REFERENCE_SHARE = 0.25  # of a scene's time
PICTURE_S = 0.4  # to draw one, kept free of `--time`, but never more than a quarter of it


class Stopped(KeyboardInterrupt):
    """A signal asks to end."""

    def __init__(self, number):
        super().__init__()
        self.number = number


def listen():
    """The first signal raises Stopped, later ones do nothing: results are being written."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

    def stop(number, _):
        for n in numbers:
            signal.signal(n, signal.SIG_IGN)
        raise Stopped(number)
    for n in numbers:
        signal.signal(n, stop)


def measure_scene(scene, o, renderer, end, result, progress):
    """Level by level, each method with all seeds if that fits before `end` (monotonic seconds);
    seeds outside, methods inside, so that a disturbance hits all alike."""
    progress.stage(f"{result['name']}: reference")
    ref = reference.make_reference(scene, renderer, o.cache, REFERENCE_SHARE * (end - time.monotonic()))
    result["reference"] = {"spp": ref.spp, "seconds": ref.seconds, "mse": float(ref.variance.mean()),
                           "flip": ref.flip_noise}
    took, spp = {}, 1
    while spp <= o.max_spp:
        fits, left = [], end - time.monotonic()
        for m in o.chosen:
            need = 2.2 * took.get((m.name, spp // 2), 0.0 if spp == 1 else 1e30)
            if need <= left:
                fits.append(m)
                left -= need
        if not fits:
            return
        progress.stage(f"{result['name']}: {spp} spp, {len(fits)} of {len(o.chosen)} methods")
        for seed in range(o.seeds):
            for m in fits:
                if time.monotonic() >= end:
                    return
                progress.detail(f"{m.name}, seed {seed}")
                begun = time.monotonic()
                picture, record = renderer.render(scene, m, spp, seed)
                record["seconds"] = record[o.clock + "_s"]
                record.update(measure.errors_of(picture, ref))
                result["runs"].append(record)
                took[m.name, spp] = took.get((m.name, spp), 0) + time.monotonic() - begun
        spp *= 2


def measure_all(o, results, progress):
    """Exit code; what was measured until then stands in `results`."""
    start = time.monotonic()
    pictures = len(o.scenes) * len(analysis.MEASURES) + 1
    measuring = o.time - min(PICTURE_S * pictures if png.available() else 0.0, o.time / 4)
    with tempfile.TemporaryDirectory() as folder:
        renderer = measure.Renderer(o.renderer, folder, o.threads, o.width)
        try:
            for i, scene in enumerate(o.scenes):
                name = os.path.splitext(os.path.basename(scene))[0]
                results.append({"name": name, "runs": []})
                end = start + measuring * (i + 1) / len(o.scenes)
                measure_scene(scene, o, renderer, end, results[-1], progress)
            return 0
        except Stopped as stopped:
            return 128 + stopped.number
        except measure.RenderError as error:
            progress.end()
            print(error, file=sys.stderr)
            return error.code


def cpu_model():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown")


def pictures_of(table):
    """(name, SVG, what draws the same with matplotlib) of everything that there is to draw."""
    for r in table["scenes"]:
        for measure in analysis.MEASURES:
            if drawn(r["summary"], measure):
                name = r["name"] + ("" if measure == "mse" else "-" + measure)
                yield name, error_svg(r, measure), functools.partial(png.error_png, r, measure)
    if table["accelerators"]["points"]:
        data = table["accelerators"]
        yield "accelerators", accelerator_svg(data), functools.partial(png.accelerator_png, data)


def report(o, version, results, second, complete):
    """Writes everything; nothing where nothing was measured."""
    results = [r for r in results if r["runs"]]
    for r in results:
        r["summary"] = analysis.summary(r["runs"])
    if not results:
        return
    table = {"renderer": version, "cpu": cpu_model(), "clock": o.clock, "threads": o.threads, "width": o.width,
             "seeds": o.seeds, "time_s": o.time, "complete": complete, "scenes": results,
             "methods": [{"name": m.name, "choices": m.choices} for m in o.chosen], "accelerators": second}
    write(os.path.join(o.out, "chart.json"), json.dumps(table) + "\n")
    write(os.path.join(o.out, "chart.html"), page(table))
    for name, svg, draw in pictures_of(table):
        write(os.path.join(o.out, name + ".svg"), svg)
        if png.available():
            write(os.path.join(o.out, name + ".png"), draw())
    for r in results:
        if r["summary"]:
            print(analysis.text(r))


def second_chart(o):
    """Its numbers; no points, and why, where there is nothing to compare."""
    bench = o.bench or accelerators.widest(o.results)
    stability = o.stability or next(iter(accelerators.results(o.results, "stability")), None)
    if not bench or not stability:
        return {"points": [], "why": "no results of tools/bench and tools/stability"}
    second = accelerators.compare(accelerators.load(bench), accelerators.load(stability))
    return second if second["points"] else {"points": [], "why": "tools/bench and tools/stability share no accelerator"}


def main(arguments):
    o = options.parse(arguments)
    for scene in o.scenes:
        if not os.path.isfile(scene):
            print(f"{scene}: error: cannot open (got no file, expected a scene)", file=sys.stderr)
            return 3
    try:
        version = measure.version(o.renderer)
    except OSError as error:
        print(f"{o.renderer}: error: cannot run: {error.strerror}", file=sys.stderr)
        return 6
    try:
        second = second_chart(o)
    except accelerators.InputError as error:
        print(error, file=sys.stderr)
        return 4
    if not png.available():
        print("warning: no PNG: python3-matplotlib is not installed", file=sys.stderr)
    progress, results = Progress(o.quiet), []
    listen()
    try:
        os.makedirs(o.out, exist_ok=True)
        tempfile.TemporaryFile(dir=o.out).close()
        code = measure_all(o, results, progress)
        progress.end()
        report(o, version, results, second, code == 0)
    except OSError as error:
        print(f"{error.filename or o.out}: error: cannot write: {error.strerror}", file=sys.stderr)
        return 5
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
