"""HDR-FLIP: the largest FLIP over the exposures at which a picture can be looked at.

Andersson, Nilsson, Shirley, Akenine-Moeller: "Visualizing Errors in Rendered High Dynamic Range Images"
(Eurographics short papers 2021).
"""
import math

import numpy as np

from chart_src.flip import PIXELS_PER_DEGREE, Seen, difference_of
from chart_src.flip_colour import LUMINANCE

# Narkowicz 2015, "ACES filmic tone mapping curve", with that page's 0.6 for the exposure in it.
NUMERATOR = np.array([0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0])
DENOMINATOR = np.array([0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14])
BRIGHT = 0.85  # where the curve bends: what is mapped to it is neither lost in white nor in black


def tone_map(rgb):
    return np.clip(np.polyval(NUMERATOR, rgb) / np.polyval(DENOMINATOR, rgb), 0, 1)


def exposures(reference):
    """Powers of two, a step apart at most: from that which maps the brightest pixel to BRIGHT to that
    which maps the median there. Black pixels have no exposure and do not count."""
    y = (reference @ LUMINANCE).ravel()
    y = y[y > 0]
    if not len(y):
        return np.zeros(1)
    level = max(np.roots(NUMERATOR - BRIGHT * DENOMINATOR).real)
    first, last = math.log2(level / y.max()), math.log2(level / np.median(y))
    return np.linspace(first, last, max(2, math.ceil(last - first)))


class HdrFlip:
    """Pictures of linear RGB, not negative, against one `reference` (height, width, 3)."""

    def __init__(self, reference, ppd=PIXELS_PER_DEGREE):
        self.scales, self.ppd = 2.0 ** exposures(reference), ppd
        self.reference = self.seen(reference)

    def seen(self, rgb):
        return Seen(tone_map(self.scales[:, None, None, None] * rgb), self.ppd)

    def pixels(self, rgb):
        """(height, width)."""
        return difference_of(self.reference, self.seen(rgb)).max(axis=0)

    def mean(self, rgb):
        return float(self.pixels(rgb).mean())
