"""tools/chart: the rounds of measurements, then chart.json and the pictures.

Exit codes: 0 done, 2 usage, 3 scene, 4 results that cannot be read, 5 output, 6 no renderer, 128+n stopped by signal n (what was
measured is written), else the renderer's own.
"""
import os
import signal
import sys
import tempfile
import time

sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

from chart_src import accelerators, analysis, measure, options, png, reference, report  # noqa: E402
from chart_src.progress import Progress  # noqa: E402
from chart_src.schedule import fitting  # noqa: E402

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
    took, spp, all_s = {}, 1, end - time.monotonic()
    while spp <= o.max_spp:
        names = fitting([m.name for m in o.chosen], took, spp, o.max_spp, end - time.monotonic(), all_s)
        fits = [m for m in o.chosen if m.name in names]
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
        second, before = report.second_chart(o), report.earlier(o, version)
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
        report.write_all(o, version, before, results, second, code == 0)
    except OSError as error:
        print(f"{error.filename or o.out}: error: cannot write: {error.strerror}", file=sys.stderr)
        return 5
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
