"""FLIP: how much two pictures differ for an eye that sees them alternate, 0 to 1 a pixel.

Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for
Alternating Images" (HPG 2020), LDR-FLIP; symbols as there. Arrays are (..., height, width, 3).
"""
import math

import numpy as np

from chart_src.flip_colour import hunt, hyab, lab, opponent, rgb_of_opponent

PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * math.pi / 180  # a screen 0.7 m and 3840 pixels wide, 0.7 m away
QC, PC, PT, QF = 0.7, 0.4, 0.95, 0.5
FEATURE_WIDTH = 0.082  # degrees: of the edges and points that are looked for
# Contrast sensitivity of each channel in space: sums of a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees; (a, b).
SENSITIVITY = [[(1.0, 0.0047)], [(1.0, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]]


def blur_matrix(size, kernel):
    """(size, size) matrix that applies an odd `kernel` to a line of pixels whose ends are repeated."""
    radius, matrix = len(kernel) // 2, np.zeros((size, size))
    rows = np.arange(size)
    for offset, weight in zip(range(-radius, radius + 1), kernel):
        np.add.at(matrix, (rows, np.clip(rows + offset, 0, size - 1)), weight)
    return matrix


def apply(along_y, along_x, channel):
    """A separable filter; `channel` is (..., height, width), the kernels are those of blur_matrix."""
    height, width = channel.shape[-2:]
    return blur_matrix(height, along_y) @ channel @ blur_matrix(width, along_x).T


def blurred(colour, ppd):
    """What the eye resolves of YyCxCz: eq. 2; each channel's filter sums to 1."""
    widest = max(b for gaussians in SENSITIVITY for _, b in gaussians)
    radius = math.ceil(3 * math.sqrt(widest / (2 * math.pi ** 2)) * ppd)
    x = np.arange(-radius, radius + 1) / ppd
    out = []
    for i, gaussians in enumerate(SENSITIVITY):
        lines = [(a * math.sqrt(math.pi / b), np.exp(-(math.pi * x) ** 2 / b)) for a, b in gaussians]
        total = sum(weight * line.sum() ** 2 for weight, line in lines)
        out.append(sum(weight / total * apply(line, line, colour[..., i]) for weight, line in lines))
    return np.stack(out, -1)


def seen(colour, ppd):
    """Of YyCxCz: Hunt-adjusted CIELAB of what is resolved, within what a screen shows."""
    return hunt(lab(np.clip(rgb_of_opponent(blurred(colour, ppd)), 0, 1)))


def colour_difference(a, b):
    """From 0 to 1, the small differences (below PC of the largest) spread over PT of that: eq. 7, 8."""
    green, blue = (hunt(lab(np.array(rgb))) for rgb in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    largest = hyab(green, blue) ** QC
    difference, knee = hyab(a, b) ** QC, PC * largest
    return np.where(difference < knee, PT / knee * difference,
                    PT + (difference - knee) / (largest - knee) * (1 - PT))


def halves_to_one(kernel):
    """Its positive weights sum to 1, its negative ones to -1."""
    return np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())


def features(grey, ppd):
    """(strength of edges, strength of points): norms of first and second derivatives of a Gaussian; eq. 9."""
    sigma = 0.5 * FEATURE_WIDTH * ppd
    radius = math.ceil(3 * sigma)
    x = np.arange(-radius, radius + 1)
    gaussian = np.exp(-x ** 2 / (2 * sigma ** 2))
    edge, point = halves_to_one(-x * gaussian), halves_to_one((x ** 2 / sigma ** 2 - 1) * gaussian)
    gaussian = gaussian / gaussian.sum()
    return [np.hypot(apply(gaussian, line, grey), apply(line, gaussian, grey)) for line in (edge, point)]


class Seen:
    """One picture of linear RGB, clamped to 0..1, as FLIP sees it; kept where many are compared to it."""

    def __init__(self, rgb, ppd=PIXELS_PER_DEGREE):
        colour = opponent(np.clip(rgb, 0, 1))
        self.colour = seen(colour, ppd)
        self.features = features((colour[..., 0] + 16) / 116, ppd)


def difference_of(a, b):
    """FLIP of each pixel of two Seen: colour, amplified where edges or points differ: eq. 10, 11."""
    feature = np.maximum(*(np.abs(p - q) for p, q in zip(a.features, b.features)))
    return colour_difference(a.colour, b.colour) ** (1 - (feature / math.sqrt(2)) ** QF)


def flip(a, b, ppd=PIXELS_PER_DEGREE):
    """(..., height, width) of two pictures of linear RGB; what is below 0 or above 1 is cut off."""
    return difference_of(Seen(a, ppd), Seen(b, ppd))
