#!/usr/bin/env python3
"""FLIP of tools/chart on pictures whose differences are known. Skipped (77) without numpy."""
import math
import os
import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("SKIPPED: needs python3-numpy")
    sys.exit(77)
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools"))
from chart_src.flip import flip  # noqa: E402
from chart_src.flip_colour import lab  # noqa: E402
from chart_src.flip_hdr import HdrFlip, exposures, tone_map  # noqa: E402


def grey(value, height=24, width=24):
    return np.full((height, width, 3), float(value))


def waves(contrast=1.0):
    y, x = np.mgrid[0:48, 0:64]
    lines = (np.sin(x / 7), np.cos(y / 5), np.sin((x + y) / 11))
    return np.stack([0.5 + 0.5 * contrast * line for line in lines], -1)


def bright():
    return np.exp(2 * np.sin(np.mgrid[0:48, 0:64][0] / 20))[..., None]


class Flip(unittest.TestCase):
    def test_equal_pictures_do_not_differ(self):
        self.assertEqual(flip(waves(), waves()).max(), 0)

    def test_cielab_of_the_primaries_is_as_published(self):
        # Any table of sRGB in CIELAB (D65, 2 degrees).
        for rgb, expected in (((1, 1, 1), (100, 0, 0)), ((0, 0, 0), (0, 0, 0)), ((1, 0, 0), (53.24, 80.09, 67.20)),
                              ((0, 1, 0), (87.74, -86.18, 83.18)), ((0, 0, 1), (32.30, 79.19, -107.86))):
            np.testing.assert_allclose(lab(np.array(rgb, float)), expected, atol=0.02)

    def test_white_on_black_is_what_one_computes_by_hand(self):
        # Constant pictures: nothing to blur, no features. HyAB of L = 100 and 0 is 100; the largest is
        # that of green and blue, a and b times L/100; then the power 0.7 and the upper piece of eq. 8.
        a, b = 0.8774 * -86.18 - 0.3230 * 79.19, 0.8774 * 83.18 + 0.3230 * 107.86
        largest = (87.74 - 32.30 + math.hypot(a, b)) ** 0.7
        expected = 0.95 + 0.05 * (100 ** 0.7 - 0.4 * largest) / (largest - 0.4 * largest)
        difference = flip(grey(0), grey(1))
        np.testing.assert_allclose(difference, expected, atol=1e-4)

    def test_small_differences_grow_by_the_lower_piece(self):
        # L of grey 0.18 and 0.2 by CIE's formula; below the knee: 0.95 / (0.4 largest) dL^0.7.
        lightness = [116 * y ** (1 / 3) - 16 for y in (0.18, 0.2)]
        expected = 0.95 * (lightness[1] - lightness[0]) ** 0.7 / (0.4 * 203.3 ** 0.7)
        np.testing.assert_allclose(flip(grey(0.18), grey(0.2)), expected, rtol=2e-3)

    def test_it_is_symmetric(self):
        a, b = np.random.default_rng(1).random((2, 20, 30, 3))
        np.testing.assert_allclose(flip(a, b), flip(b, a), rtol=1e-12)

    def test_more_contrast_differs_more(self):
        means = [flip(waves(), waves(c)).mean() for c in (1, 0.95, 0.8, 0.5, 0.2, 0)]
        self.assertEqual(means, sorted(means))
        self.assertGreater(means[1], 0.01)

    def test_a_feature_that_moves_differs_where_it_was_and_where_it_is(self):
        a, b = grey(0.2, 60, 90), grey(0.2, 60, 90)
        a[30, 25], b[30, 65] = 1, 1
        difference = flip(a, b)
        for x in (25, 65):
            self.assertEqual(difference[20:40, x - 9:x + 10].max(), difference[30, x])
            self.assertGreater(difference[30, x], 0.3)
        self.assertLess(difference[:, 45].max(), 1e-6)  # further than what the eye blurs

    def test_it_moves_with_the_pictures(self):
        a, b = np.random.default_rng(2).random((2, 40, 60, 3))
        inner = (slice(14, -14), slice(14, -16))  # beyond the reach of the repeated borders
        shifted = flip(np.roll(a, (3, 5), (0, 1)), np.roll(b, (3, 5), (0, 1)))
        np.testing.assert_allclose(shifted[17:-11, 19:-11], flip(a, b)[inner], atol=1e-9)

    def test_what_is_too_fine_for_the_eye_differs_less_from_further_away(self):
        y, x = np.mgrid[0:40, 0:40]
        board = np.where(((x + y) % 2)[..., None] == 1, np.ones(3), np.zeros(3))
        near, far = (flip(board, grey(0.5, 40, 40), ppd).mean() for ppd in (20, 200))
        self.assertGreater(near, 0.5)
        self.assertLess(far, 0.3 * near)

    def test_values_are_those_of_the_authors_program(self):
        # flip-evaluator 1.7: evaluate(a, b, "LDR", inputsRGB=False, applyMagma=False); its arithmetic is float.
        a = waves()
        for b, mean, largest, one in ((waves(0.8), 0.388402, 0.666824, 0.553722),
                                      (np.roll(a, 3, 1), 0.346225, 0.719270, 0.418473)):
            difference = flip(a, b)
            np.testing.assert_allclose((difference.mean(), difference.max(), difference[20, 30]),
                                       (mean, largest, one), atol=1e-4)


class HighRange(unittest.TestCase):
    def test_values_are_those_of_the_authors_program(self):
        # The same with "HDR".
        difference = HdrFlip(waves() * bright()).pixels(waves(0.8) * bright())
        np.testing.assert_allclose((difference.mean(), difference.max(), difference[20, 30]),
                                   (0.503509, 0.975330, 0.884244), atol=1e-4)

    def test_exposures_reach_from_the_brightest_to_the_median(self):
        picture = grey(0.5)
        picture[0, :8] = 64
        scales = 2.0 ** exposures(picture)
        np.testing.assert_allclose(tone_map(np.array([64 * scales[0], 0.5 * scales[-1]])), 0.85, atol=1e-6)
        self.assertEqual(len(scales), 7)  # log2(64 / 0.5) steps

    def test_brighter_light_is_the_same_picture(self):
        a, b = waves() * bright(), waves(0.7) * bright()
        np.testing.assert_allclose(HdrFlip(8 * a).pixels(8 * b), HdrFlip(a).pixels(b), atol=1e-9)

    def test_it_sees_what_a_screen_cuts_off(self):
        a, b = grey(0.3), grey(0.3)
        a[8:16, 8:16], b[8:16, 8:16] = 20, 40
        self.assertEqual(flip(a, b).max(), 0)
        self.assertGreater(HdrFlip(a).mean(b), 0.01)

    def test_a_black_picture_has_an_answer(self):
        self.assertEqual(HdrFlip(grey(0)).mean(grey(0)), 0)
        self.assertGreater(HdrFlip(grey(0)).mean(grey(1)), 0.5)


if __name__ == "__main__":
    unittest.main()
