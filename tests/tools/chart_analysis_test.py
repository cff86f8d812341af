#!/usr/bin/env python3
"""What tools/chart makes of runs: errors freed of the reference's noise, the reference, the summary of a
scene. Skipped (77) without numpy."""
import os
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

try:
    import numpy as np
except ImportError:
    print("SKIPPED: needs python3-numpy")
    sys.exit(77)
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools"))
from chart_src import analysis, measure, methods, page, reference, stop  # noqa: E402

SIZE = (32, 32, 3)
TRUTH = 0.5 + 0.3 * np.sin(np.arange(32 * 32 * 3)).reshape(SIZE)


def runs_of(name, seconds_per_spp, error, seeds=4, levels=(1, 2, 4, 8), raw=1.0):
    """`error(spp, seed)` is the MSE; the other measures follow it."""
    return [{"method": name, "spp": n, "seed": s, "seconds": n * seconds_per_spp, "mse": error(n, s),
             "mse_raw": raw * error(n, s), "relmse": 2 * error(n, s), "flip": error(n, s) ** 0.5,
             "outlier_share": 0.01}
            for n in levels for s in range(seeds)]


def power_law(scale, exponent):
    return lambda n, seed: scale * n ** exponent * 1.1 ** (seed - 1.5)


class Errors(unittest.TestCase):
    def test_no_method_is_charged_for_the_noise_of_the_reference(self):
        rng = np.random.default_rng(1)
        mse, raw, rel = [], [], []
        for _ in range(300):
            halves = [TRUTH + rng.normal(0, 0.02, SIZE) for _ in range(2)]
            picture = TRUTH + rng.normal(0, 0.02, SIZE)
            ref = reference.Reference.__new__(reference.Reference)
            ref.mean, ref.variance = sum(halves) / 2, reference.reference_variance(*halves)
            ref.flip = type("NoFlip", (), {"mean": staticmethod(lambda picture: 0.0)})
            errors = measure.errors_of(picture, ref)
            mse.append(errors["mse"])
            raw.append(errors["mse_raw"])
            rel.append(errors["relmse"])
        self.assertAlmostEqual(np.mean(mse) / 4e-4, 1, delta=0.01)  # the picture's own variance
        self.assertAlmostEqual(np.mean(raw) / 6e-4, 1, delta=0.01)  # and that of the mean of two halves
        self.assertAlmostEqual(np.mean(rel) / np.mean(4e-4 / (TRUTH ** 2 + 0.01)), 1, delta=0.04)

    def test_the_share_of_the_worst_pixels(self):
        square = np.full((50, 40, 3), 1.0)  # 2000 pixels: 2 of them are 0.1 %
        self.assertAlmostEqual(measure.outlier_share(square), 0.001)
        square[0, :2] = 1998
        self.assertAlmostEqual(measure.outlier_share(square), 2 / 3)
        self.assertEqual(measure.outlier_share(0 * square), 0)


class FakeRenderer:
    """Noise of the seed with the variance noise^2 / spp; a millisecond of a clock of its own for each sample."""

    program, width, now_s = "true", 32, 0.0

    def __init__(self, noise=1.0):
        self.calls, self.noise = [], noise

    def render(self, scene, method, spp, seed):
        self.calls.append((spp, seed))
        FakeRenderer.now_s += 1e-3 * spp
        return TRUTH + np.random.default_rng(seed).normal(0, self.noise * spp ** -0.5, SIZE), {}


class References(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.scene, self.cache = os.path.join(holder.name, "scene.xml"), os.path.join(holder.name, "cache")
        self.write("<scene/>")
        clock = unittest.mock.patch.object(reference.time, "monotonic", lambda: FakeRenderer.now_s)
        clock.start()
        self.addCleanup(clock.stop)

    def write(self, text):
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(text)

    def test_it_says_its_own_error(self):
        renderer = FakeRenderer()
        ref = reference.make_reference(self.scene, renderer, self.cache, 0.2, 1024)
        self.assertEqual(len({seed for _, seed in renderer.calls}), len(renderer.calls))  # independent
        self.assertEqual(ref.spp, sum(spp for spp, _ in renderer.calls))
        self.assertGreater(ref.spp, 50)
        self.assertLess(ref.seconds, 0.2)
        self.assertAlmostEqual(ref.variance.mean() * ref.spp, 1, delta=0.15)
        self.assertAlmostEqual(((ref.mean - TRUTH) ** 2).mean() * ref.spp, 1, delta=0.15)

    def test_pictures_without_noise_are_kept_as_they_are(self):
        ref = reference.make_reference(self.scene, FakeRenderer(noise=0), self.cache, 0.01, 1024)
        np.testing.assert_allclose(ref.mean, TRUTH, rtol=1e-12)

    def test_it_ends_where_it_is_good_enough(self):
        renderer = FakeRenderer()
        ref = reference.make_reference(self.scene, renderer, self.cache, 1e9, 2)
        self.assertTrue(64 * 2 <= ref.spp < 4 * 64 * 2)
        again = FakeRenderer()
        reference.make_reference(self.scene, again, self.cache, 1e9, 2)
        self.assertEqual(again.calls, [])

    def test_it_is_made_once_and_refined_where_there_is_more_time(self):
        first = reference.make_reference(self.scene, FakeRenderer(), self.cache, 0.1, 1024)
        again = FakeRenderer()
        same = reference.make_reference(self.scene, again, self.cache, first.seconds, 1024)
        self.assertEqual((again.calls, same.spp), ([], first.spp))
        np.testing.assert_array_equal(same.mean, first.mean)
        more = FakeRenderer()
        better = reference.make_reference(self.scene, more, self.cache, 6 * first.seconds, 1024)
        self.assertGreater(better.spp, first.spp)
        self.assertEqual(better.spp, first.spp + sum(spp for spp, _ in more.calls))
        self.assertAlmostEqual(((better.mean - TRUTH) ** 2).mean() * better.spp, 1, delta=0.15)

    def test_another_scene_or_size_is_another_reference(self):
        keys = [reference.key_of(self.scene, FakeRenderer())]
        wide = FakeRenderer()
        wide.width = 33
        keys.append(reference.key_of(self.scene, wide))
        mesh = os.path.join(os.path.dirname(self.scene), "mesh.obj")
        for text in ("one", "two"):
            with open(mesh, "w", encoding="utf-8") as file:
                file.write(text)
            self.write('<scene><string name="filename" value="mesh.obj"/></scene>')
            keys.append(reference.key_of(self.scene, FakeRenderer()))
        self.assertEqual(len(set(keys)), 4)


# As a renderer: a picture of one pixel, rendered in half a millisecond, as it says.
PROGRAM = """#!/bin/sh
while [ $# -gt 0 ]; do
    case $1 in -o) image=$2 ;; --stats) stats=$2 ;; esac
    shift
done
printf 'PF\\n1 1\\n-1\\n\\000\\000\\200\\077\\000\\000\\000\\100\\000\\000\\100\\100' >"$image"
i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); done
echo '{"render_s": 0.0005, "total_s": 0.001, "samples": 4, "rays": {"total": 9}, "peak_bytes": 5}' >"$stats"
"""


class Rendering(unittest.TestCase):
    def test_the_start_of_the_process_is_not_counted(self):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "renderer")
            with open(program, "w", encoding="utf-8") as file:
                file.write(PROGRAM)
            os.chmod(program, 0o755)
            picture, record = measure.Renderer(program, folder, 1, 8).render(__file__, methods.Method("default", {}), 4, 0)
        np.testing.assert_array_equal(picture, [[[1, 2, 3]]])
        self.assertEqual((record["wall_s"], record["samples"], record["rays"], record["memory_bytes"]), (0.0005, 4, 9, 5))
        self.assertTrue(0 < record["cpu_s"] <= 0.0005, record)  # of some ms of the process


class Stopping(unittest.TestCase):
    def setUp(self):
        for number in stop.NUMBERS:
            self.addCleanup(signal.signal, number, signal.getsignal(number))
        stop.listen()

    def test_the_first_signal_ends_and_later_ones_do_nothing(self):
        with self.assertRaises(stop.Stopped) as caught:
            os.kill(os.getpid(), signal.SIGTERM)
        self.assertEqual(caught.exception.number, signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGINT)

    def test_what_is_held_is_done_first(self):
        done = False
        with self.assertRaises(stop.Stopped) as caught, stop.held():
            os.kill(os.getpid(), signal.SIGINT)
            done = True
        self.assertTrue(done)
        self.assertEqual(caught.exception.number, signal.SIGINT)
        with stop.held():  # and that once
            pass

    def test_a_renderer_that_is_just_starting_is_ended_too(self):
        started, popen = [], subprocess.Popen

        def start(_, **options):
            started.append(popen(["sleep", "60"], **options))
            os.kill(os.getpid(), signal.SIGTERM)
            return started[0]
        renderer = measure.Renderer("renderer", "/tmp", 1, 8)
        with unittest.mock.patch.object(measure.subprocess, "Popen", start), self.assertRaises(stop.Stopped):
            renderer.render(__file__, methods.Method("default", {}), 1, 0)
        self.assertEqual(started[0].returncode, -signal.SIGKILL)


class Summary(unittest.TestCase):
    def row(self, runs, name):
        return next(r for r in analysis.summary(runs) if r["method"] == name)

    def test_numbers_of_power_laws_are_theirs(self):
        runs = runs_of("default", 0.5, power_law(3, -1.5)) + runs_of("worst", 2.0, power_law(5, -1))
        default, worst = self.row(runs, "default"), self.row(runs, "worst")
        for row, exponent in ((default, -1.5), (worst, -1)):
            np.testing.assert_allclose(row["slope"], exponent, atol=1e-9)  # each seed has just that
            self.assertIsNone(row["bend"])
        # 1 / (MSE s) at 8 samples in 4 seconds; ln 1.1 apart, so the interval by hand with t = 3.182.
        mean = 1 / (3 * 8 ** -1.5 * 4)
        spread = np.exp(3.182 * np.log(1.1) * (5 / 3) ** 0.5 / 2)
        np.testing.assert_allclose(default["efficiency"], (mean, mean / spread, mean * spread), rtol=1e-6)
        # worst's error at 8 samples and 16 s, 5/8, is that of the default at (3 8/5)^(2/3) samples.
        factor = worst["factor"]
        times = 16 / (0.5 * (24 / 5) ** (2 / 3))
        self.assertAlmostEqual(factor["times"] / times, 1, delta=0.01)
        self.assertTrue(factor["low"] < factor["times"] < factor["high"])
        self.assertFalse(factor["extrapolated"])
        self.assertIsNone(default["factor"])

    def test_the_front_of_each_measure_holds_what_nothing_beats(self):
        runs = runs_of("default", 1, power_law(1, -1)) + runs_of("slow", 2, power_law(1, -1))
        for run in runs:  # by FLIP the slow one is by far the better
            run["flip"] *= 0.01 if run["method"] == "slow" else 1
        default, slow = self.row(runs, "default"), self.row(runs, "slow")
        self.assertEqual([p["front"] for p in default["points"]], [["mse", "relmse", "flip"]] + 3 * [["mse", "relmse"]])
        self.assertEqual([p["front"] for p in slow["points"]], 4 * [["flip"]])

    def test_a_curve_ends_where_the_reference_ends(self):
        runs = runs_of("default", 1, power_law(1, -1), levels=(1, 2, 4)) + runs_of("default", 1, power_law(1, -1), levels=(8,), raw=2.1)
        self.assertEqual([p["spp"] for p in self.row(runs, "default")["points"]], [1, 2, 4])

    def test_a_level_without_all_its_seeds_does_not_count(self):
        runs = [r for r in runs_of("default", 1, power_law(1, -1)) if (r["spp"], r["seed"]) != (8, 3)]
        self.assertEqual([p["spp"] for p in self.row(runs, "default")["points"]], [1, 2, 4])

    def test_bias_is_a_bend(self):
        rng = np.random.default_rng(4)

        def biased(n, _):
            return (1 / n + 1 / 16) * rng.normal(1, 0.02)
        runs = runs_of("default", 1, biased, levels=[2 ** i for i in range(9)])
        at, before, after = self.row(runs, "default")["bend"]
        self.assertTrue(8 <= at <= 32, at)
        self.assertTrue(before < -0.6 and after > -0.35)
        self.assertEqual(analysis.cause(self.row(runs, "default")), "bias")
        for run in runs:  # the same curve, but a few pixels hold it up in most seeds
            run["outlier_share"] = 0.6 if run["spp"] == 256 and run["seed"] != 0 else 0.01
        self.assertEqual(analysis.cause(self.row(runs, "default")), "fireflies")
        self.assertIn("(fireflies)", analysis.text({"name": "s", "reference": {"spp": 1, "mse": 1},
                                                    "summary": analysis.summary(runs)}))
        texts = page.cells(self.row(runs, "default"))
        self.assertIn("flatter from", texts[2])
        self.assertIn("(fireflies)", texts[2])
        self.assertEqual(texts[5], "60 %")
        straight = runs_of("default", 1, lambda n, _: rng.normal(1, 0.05) / n, levels=[2 ** i for i in range(9)])
        self.assertIsNone(self.row(straight, "default")["bend"])

    def test_beyond_a_curve_it_is_extrapolated_or_unknown(self):
        default = runs_of("default", 1, power_law(1, -2))
        better = self.row(default + runs_of("better", 1, power_law(0.01, -2)), "better")["factor"]
        self.assertTrue(better["extrapolated"])
        self.assertAlmostEqual(better["times"], 0.1, delta=1e-4)
        stuck = runs_of("stuck", 1, lambda n, _: 50.0)  # never as good as the default's first point
        self.assertIsNone(self.row(default + stuck, "stuck")["factor"])


if __name__ == "__main__":
    unittest.main()
