"""Colour spaces of FLIP: linear BT.709 RGB, XYZ, YyCxCz and CIELAB; arrays end in three channels.

Andersson et al. 2020, section 4; BT.709's primaries and D65 as in ITU-R BT.709-6, table 1.
"""
import numpy as np

PRIMARIES = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])
WHITE = np.array([0.3127, 0.3290])


def xyz_of_chromaticity(xy):
    """With Y = 1."""
    return np.stack([xy[..., 0] / xy[..., 1], np.ones_like(xy[..., 0]), (1 - xy.sum(-1)) / xy[..., 1]], -1)


def rgb_to_xyz_matrix():
    """Columns are the primaries, scaled so that their sum is the white point."""
    columns = xyz_of_chromaticity(PRIMARIES).T
    return columns * np.linalg.solve(columns, xyz_of_chromaticity(WHITE))


TO_XYZ = rgb_to_xyz_matrix()
WHITE_XYZ = TO_XYZ.sum(axis=1)
LUMINANCE = TO_XYZ[1]
# YyCxCz = OPPONENT (X/Xn, Y/Yn, Z/Zn) - (16, 0, 0): linear in RGB, so that it may be blurred.
OPPONENT = np.array([[0.0, 116.0, 0.0], [500.0, -500.0, 0.0], [0.0, 200.0, -200.0]])
TO_OPPONENT = OPPONENT @ (TO_XYZ / WHITE_XYZ[:, None])
FROM_OPPONENT = np.linalg.inv(TO_OPPONENT)
BLACK = np.array([16.0, 0.0, 0.0])


def opponent(rgb):
    """YyCxCz of linear RGB."""
    return rgb @ TO_OPPONENT.T - BLACK


def rgb_of_opponent(colour):
    return (colour + BLACK) @ FROM_OPPONENT.T


def lab(rgb):
    """CIELAB of linear RGB (CIE 15), to the white of BT.709."""
    t = rgb @ (TO_XYZ / WHITE_XYZ[:, None]).T
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def hunt(colour):
    """CIELAB with colourfulness that grows with lightness (Hunt's effect): eq. 5."""
    return colour * np.stack([np.ones_like(colour[..., 0])] + 2 * [0.01 * colour[..., 0]], -1)


def hyab(a, b):
    """Distance in CIELAB for large differences (Abasi et al. 2020): eq. 6."""
    d = a - b
    return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])
