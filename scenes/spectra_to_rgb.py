#!/usr/bin/env python3
"""The colours of cornell-box.xml: the measured spectra of the Cornell box as linear Rec. 709.

Data: Cornell University Program of Computer Graphics, "Cornell Box Data",
https://www.graphics.cornell.edu/online/box/data.html (reflectances every 4 nm, the lamp's emission
every 100 nm, linear between).

How. The lamp's radiance L is projected on the CIE 1931 colour matching functions, divided by the
integral of y (so a flat spectrum of 1 has luminance 1), and turned into Rec. 709 primaries without
any adaptation. A reflectance rho becomes, channel by channel,

    rho_rgb = rgb(rho L) / rgb(L),

its ratio under the one lamp of the scene, not under a standard illuminant. So the light that
leaves a surface after one bounce, which is most of the picture, has exactly the colour that a
spectral renderer would give it, and a perfect reflector is (1, 1, 1): Ward, Eydelberg-Vileshin,
"Picture perfect RGB rendering using spectral prefiltering and sharp color primaries", Eurographics
Workshop on Rendering 2002. What remains is the error of later bounces.

Run it: it prints the values that stand in the scene file; --check FILE.xml fails if one differs.
"""
import math
import re
import sys

# Reflectances at 400, 404 ... 700 nm.
WHITE = [
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758,
    0.739, 0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750,
    0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733, 0.725, 0.732, 0.743,
    0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736,
    0.734, 0.741, 0.740, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731,
    0.712, 0.708, 0.729, 0.730, 0.727, 0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739,
    0.724, 0.730, 0.740, 0.737,
]
GREEN = [
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098,
    0.096, 0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187,
    0.229, 0.285, 0.343, 0.390, 0.435, 0.464, 0.472, 0.476, 0.481, 0.462, 0.447, 0.441,
    0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207,
    0.186, 0.171, 0.160, 0.148, 0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119,
    0.114, 0.115, 0.117, 0.117, 0.118, 0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146,
    0.150, 0.152, 0.157, 0.159,
]
RED = [
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057,
    0.061, 0.061, 0.060, 0.062, 0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058,
    0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059, 0.059, 0.058, 0.059,
    0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154,
    0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606,
    0.609, 0.651, 0.612, 0.610, 0.650, 0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639,
    0.657, 0.639, 0.635, 0.642,
]
LAMP = [(400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4)]  # W / (m^2 sr nm), any common factor

XYZ_TO_REC709 = (
    (3.2404542, -1.5371385, -0.4985314),
    (-0.9692660, 1.8760108, 0.0415560),
    (0.0556434, -0.2040259, 1.0572252),
)


def colour_matching(nm):
    """CIE 1931 2-degree observer: Wyman, Sloan, Shirley, "Simple analytic approximations to the
    CIE XYZ color matching functions", JCGT 2(2), 2013, multi-lobe fit."""

    def lobe(scale, mean, below, above):
        return scale * math.exp(-0.5 * ((nm - mean) / (below if nm < mean else above)) ** 2)

    return (
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    )


def between(knots, nm):
    """Linear interpolation; zero outside the measured range."""
    for (x0, y0), (x1, y1) in zip(knots, knots[1:]):
        if x0 <= nm <= x1:
            return y0 + (y1 - y0) * (nm - x0) / (x1 - x0)
    return 0.0


def rec709(spectrum):
    """The linear Rec. 709 colour of a function of nm: midpoint rule, 0.1 nm."""
    step = 0.1
    xyz, norm = [0.0, 0.0, 0.0], 0.0
    for i in range(round((830 - 360) / step)):
        nm = 360 + (i + 0.5) * step
        bars = colour_matching(nm)
        value = spectrum(nm)
        norm += bars[1]
        for c in range(3):
            xyz[c] += value * bars[c]
    return [sum(m * v / norm for m, v in zip(row, xyz)) for row in XYZ_TO_REC709]


def colours():
    lamp = rec709(lambda nm: between(LAMP, nm))
    result = {"lamp": lamp}
    for name, values in (("white", WHITE), ("green", GREEN), ("red", RED)):
        knots = list(zip(range(400, 701, 4), values))
        reflected = rec709(lambda nm: between(knots, nm) * between(LAMP, nm))
        result[name] = [r / l for r, l in zip(reflected, lamp)]
    return result


def main(arguments):
    found = {name: ", ".join(f"{c:.6f}" for c in rgb) for name, rgb in colours().items()}
    for name, text in found.items():
        print(f"{name}: {text}")
    if len(arguments) == 2 and arguments[0] == "--check":
        with open(arguments[1], encoding="utf-8") as file:
            in_scene = re.findall(r'<rgb [^>]*value="([^"]*)"', file.read())
        missing = [name for name, text in found.items() if text not in in_scene]
        for name in missing:
            print(f"{arguments[1]}: the colour of {name} is not {found[name]}", file=sys.stderr)
        return 1 if missing else 0
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
