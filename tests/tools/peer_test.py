#!/usr/bin/env python3
"""tools/peer without Mitsuba: its statistics, and what it says where something is missing.

    peer_test.py MAIN.py SCENE.xml

Skipped (77) without numpy.
"""
import importlib.util
import os
import subprocess
import sys
import unittest

if importlib.util.find_spec("numpy") is None:
    print("skipped: no numpy")
    sys.exit(77)
import numpy as np  # noqa: E402

MAIN, SCENE = sys.argv[1:3]
sys.path.insert(0, os.path.dirname(MAIN))
import efficiency  # noqa: E402


def run(*arguments):
    return subprocess.run([sys.executable, MAIN, *arguments], capture_output=True, text=True, check=False)


class Statistics(unittest.TestCase):
    def test_relative_mse_is_that_of_its_definition(self):
        self.assertAlmostEqual(efficiency.relative_mse(np.array([1.1, 0.2]), np.array([1.0, 0.0])),
                               (0.01 / 1.01 + 0.04 / 0.01) / 2)

    def test_the_noise_of_the_reference_is_what_it_adds(self):
        random = np.random.default_rng(5)
        truth = random.uniform(0.2, 1, 200_000)
        a, b = (truth + 0.02 * random.standard_normal(truth.size) for _ in range(2))
        picture = truth + 0.02 * random.standard_normal(truth.size)
        charged = efficiency.relative_mse(picture, (a + b) / 2) - efficiency.reference_share(a, b)
        self.assertAlmostEqual(charged / efficiency.relative_mse(picture, truth), 1, delta=0.02)

    def test_efficiency_is_one_over_error_and_seconds(self):
        s = efficiency.summary([0.01, 0.03], [2.0, 4.0, 100.0])
        self.assertAlmostEqual(s["efficiency"], 1 / (0.02 * 4))
        self.assertLess(s["efficiency_95"][0], s["efficiency"])
        self.assertGreater(s["efficiency_95"][1], s["efficiency"])


class Command(unittest.TestCase):
    def expect(self, code, text, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(text, done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_mistakes_are_one_line(self):
        self.expect(3, "cannot read no-such.xml", "no-such.xml")
        self.expect(2, "not a list of counts (got '4,x')", "--spp", "4,x", SCENE)
        self.expect(2, "at least", "--seeds", "1", SCENE)

    @unittest.skipIf(importlib.util.find_spec("mitsuba") is not None, "Mitsuba is here")
    def test_says_that_mitsuba_is_missing(self):
        self.expect(6, "mitsuba is not installed", SCENE)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
