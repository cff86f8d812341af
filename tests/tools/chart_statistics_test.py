#!/usr/bin/env python3
"""The statistics of tools/chart on data whose answers are known. Skipped (77) without numpy."""
import os
import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("SKIPPED: needs python3-numpy")
    sys.exit(77)
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools"))
from chart_src import statistics as st  # noqa: E402


class Statistics(unittest.TestCase):
    def test_slope_of_a_power_law_is_its_exponent(self):
        self.assertAlmostEqual(st.slope([1, 2, 4, 8], [3 * n ** -1.4 for n in (1, 2, 4, 8)]), -1.4)

    def test_front_holds_what_nothing_beats(self):
        self.assertEqual(st.pareto([(2, 5), (1, 9), (3, 6), (4, 1)]), [1, 0, 3])

    def test_interval_covers_95_percent(self):
        rng = np.random.default_rng(1)
        hits = sum(low <= 0 <= high for _, low, high in (st.mean_interval(rng.normal(size=4)) for _ in range(2000)))
        self.assertLess(abs(hits / 2000 - 0.95), 0.02)

    def test_reference_variance_is_that_of_the_mean_of_halves(self):
        a, b = np.random.default_rng(2).normal(size=(2, 100000))
        self.assertAlmostEqual(st.reference_variance(a, b).mean(), 0.5, delta=0.01)


if __name__ == "__main__":
    unittest.main()
