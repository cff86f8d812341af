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
from chart_src.schedule import fitting, kept_back  # noqa: E402


class Statistics(unittest.TestCase):
    def test_slope_of_a_power_law_is_its_exponent(self):
        self.assertAlmostEqual(st.slope([1, 2, 4, 8], [3 * n ** -1.4 for n in (1, 2, 4, 8)]), -1.4)

    def test_slope_is_that_of_least_squares(self):
        self.assertAlmostEqual(st.slope([1, 2, 4, 8], [1, 1, 1, 1 / 8]), -0.9)  # by hand, in powers of two

    def test_quantiles_are_those_of_tables(self):
        for freedom, expected in ((1, 12.706), (20, 2.086), (21, 2.080), (30, 2.042), (60, 2.000), (120, 1.980)):
            self.assertAlmostEqual(st.t95(freedom) / expected, 1, delta=0.0005)

    def test_front_holds_what_nothing_beats(self):
        self.assertEqual(st.pareto([(2, 5), (1, 9), (3, 6), (4, 1)]), [1, 0, 3])

    def test_interval_covers_95_percent(self):
        rng = np.random.default_rng(1)
        hits = sum(low <= 0 <= high for _, low, high in (st.mean_interval(rng.normal(size=4)) for _ in range(2000)))
        self.assertLess(abs(hits / 2000 - 0.95), 0.02)

    def test_reference_variance_is_that_of_the_mean_of_halves(self):
        a, b = np.random.default_rng(2).normal(size=(2, 100000))
        self.assertAlmostEqual(st.reference_variance(a, b).mean(), 0.5, delta=0.01)


class Schedule(unittest.TestCase):
    def test_the_first_level_is_for_all(self):
        self.assertEqual(fitting(["a", "b"], {}, 1, 64, 0.1, 0.1), ["a", "b"])

    def test_what_does_not_fit_is_left_out_and_stays_out(self):
        took = {("a", 1): 1.0, ("b", 1): 9.0, ("c", 1): 1.0}
        self.assertEqual(fitting(["a", "b", "c"], took, 2, 2, 10, 10), ["a", "c"])
        took |= {("a", 2): 1.0, ("c", 2): 1.0}
        self.assertEqual(fitting(["a", "b", "c"], took, 4, 4, 1000, 1000), ["a", "c"])
        self.assertEqual(fitting(["a", "b", "c"], took, 4, 4, 0, 1000), [])

    def test_the_first_method_keeps_time_for_its_later_levels(self):
        took = {(name, 1): 1.0 for name in "abcd"}  # 2.2 each now, 4.84 for a at 4
        self.assertEqual(fitting(list("abcd"), took, 2, 2, 9, 100), list("abcd"))
        self.assertEqual(fitting(list("abcd"), took, 2, 4, 9.7, 100), list("ab"))
        self.assertEqual(fitting(list("abcd"), took, 2, 4, 9.7, 16), list("abcd"))  # more than half: 1 + 2.2 + 4.84
        self.assertEqual(fitting(list("abcd"), took, 2, 4, 7.1, 100), ["a"])  # what is left is for it

    def test_levels_are_kept_for_as_far_as_they_fit(self):
        for most, levels in ((1000, 3), (7.1, 2), (7, 1), (2, 0), (-1, 0)):
            self.assertAlmostEqual(kept_back(1, 2, 16, most), sum(2.2 ** i for i in range(1, levels + 1)))


if __name__ == "__main__":
    unittest.main()
