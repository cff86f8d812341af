"""One axis as an SVG: failure rate or value against stress, a curve for each method.

Curves differ by colour, marker and dashes. What is exactly 0 lies in a band of its own below the
logarithmic scale, one lane a method, so that curves which never fail can be told apart.
"""
import html
import math

from page_src.marks import COLOURS, DASHES, STYLE, marker
from page_src.numbers import power

WIDTH, LEFT, RIGHT, TOP, PLOT = 640, 64, 14, 34, 250
LANE, ROW, AXIS_TEXT = 5, 17, 46


class Scales:
    """From stresses and rates or values to places."""

    def __init__(self, axis):
        self.axis = axis
        self.linear = max(axis.stresses) <= 90
        self.positive = [s for s in axis.stresses if s > 0]
        numbers = [axis.badness(c) for cells in axis.cells.values() for c in cells]
        finite = [n for n in numbers if 0 < n < math.inf]
        if axis.counts:
            trials = max(c["trials"] for cells in axis.cells.values() for c in cells)
            finite += [1.0, 1 / max(trials, 1)]
        else:
            finite += [axis.limit] if axis.limit > 0 else []
        self.low = math.floor(math.log10(min(finite, default=0.1)) + 1e-9)
        self.high = max(math.ceil(math.log10(max(finite, default=1)) - 1e-9), self.low + 1)
        self.has_zero = any(n == 0 for n in numbers)
        self.has_infinity = any(math.isinf(n) for n in numbers)
        self.top = TOP + (28 if self.has_infinity else 0)
        self.bottom = self.top + PLOT
        self.band = LANE * (len(axis.methods) + 1) if self.has_zero else 0

    def x(self, stress):
        span = WIDTH - LEFT - RIGHT - 28
        left = LEFT + 14
        if self.linear:
            low, high = min(self.axis.stresses), max(self.axis.stresses)
            return left + span * (stress - low) / ((high - low) or 1)
        low, high = math.log10(self.positive[0]), math.log10(self.positive[-1])
        steps = len(self.positive) - 1
        unit = (high - low) / steps if steps else 1
        if 0 in self.axis.stresses:
            low -= unit
        value = low if stress == 0 else math.log10(stress)
        return left + span * (value - low) / ((high - low) or 1)

    def y(self, number, lane):
        if number == 0:
            return self.bottom + LANE * (lane + 1)
        if math.isinf(number):
            return TOP + 9
        share = (math.log10(number) - self.low) / (self.high - self.low)
        return self.bottom - PLOT * min(max(share, 0), 1)


def grid(scales):
    axis, out = scales.axis, []
    right = WIDTH - RIGHT
    end = scales.bottom + scales.band
    if scales.has_zero:
        out.append(f'<rect class="band" x="{LEFT}" y="{scales.bottom}" width="{right - LEFT}" '
                   f'height="{scales.band}"/>')
        out.append(f'<text x="{LEFT - 6}" y="{scales.bottom + scales.band / 2 + 4:.1f}" '
                   'text-anchor="end">0</text>')
    if scales.has_infinity:
        out.append(f'<text x="{LEFT - 6}" y="{TOP + 13}" text-anchor="end">∞</text>')
    every = math.ceil((scales.high - scales.low) / 8)
    for exponent in range(scales.low, scales.high + 1):
        y = scales.y(10.0 ** exponent, 0)
        out.append(f'<path class="grid" d="M{LEFT} {y:.1f}H{right}"/>')
        if (scales.high - exponent) % every == 0:
            label = power(10.0 ** exponent)
            if axis.counts:
                label = f"{100 * 10.0 ** exponent:.6g} %" if exponent > -5 else power(10.0 ** (exponent + 2)) + " %"
            out.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end" class="small">{label}</text>')
    last = -math.inf
    for stress in axis.stresses:
        x = scales.x(stress)
        out.append(f'<path class="grid" d="M{x:.1f} {TOP}V{end}"/>')
        if x - last > 36:
            out.append(f'<text x="{x:.1f}" y="{end + 16}" text-anchor="middle" class="small">{power(stress)}</text>')
            last = x
    out.append(f'<rect class="frame" x="{LEFT}" y="{TOP}" width="{right - LEFT}" height="{end - TOP}"/>')
    out.append(f'<text x="{(LEFT + right) / 2:.0f}" y="{end + 34}" text-anchor="middle">'
               f'{html.escape(axis.unit)}</text>')
    if axis.limit > 0:
        judged = [s for m in axis.methods if m.default for s in axis.stresses if m.judged_at(s)]
        if judged:
            y = scales.y(axis.limit, 0)
            out.append(f'<path class="limit" d="M{scales.x(min(judged)) - 8:.1f} {y:.1f}'
                       f'H{scales.x(max(judged)) + 8:.1f}"><title>limit {power(axis.limit)}</title></path>'
                       f'<text class="small" x="{LEFT + 4}" y="{y - 4:.1f}">'
                       f'limit of the default {power(axis.limit)}</text>')
    return out


def curve(scales, index, method):
    axis = scales.axis
    cells = axis.cells[method.name]
    points = [(scales.x(c["stress"]), scales.y(axis.badness(c), index)) for c in cells]
    line = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    dash = DASHES[index % len(DASHES)]
    classes = f"curve c{index % COLOURS}" + (" default" if method.default else "")
    out = [f'<g><title>{html.escape(method.name)}</title><path class="{classes}" d="{line}"'
           + (f' stroke-dasharray="{dash}"' if dash and not method.default else "") + "/>"]
    for cell, (x, y) in zip(cells, points):
        if axis.counts and cell["failures"] > 0:
            low, high = (scales.y(max(cell[k], 1e-30), index) for k in ("low", "high"))
            if low - high > 7: # longer than the marker
                out.append(f'<path class="c{index % COLOURS}" d="M{x:.1f} {low:.1f}V{high:.1f}"/>')
        out.append(marker(index, x, y))
    return out + ["</g>"]


def legend(scales, top):
    axis, out = scales.axis, []
    columns = 2
    for index, method in enumerate(axis.methods):
        x = LEFT + (index % columns) * (WIDTH - LEFT - RIGHT) / columns
        y = top + ROW * (index // columns)
        dash = DASHES[index % len(DASHES)]
        classes = f"curve c{index % COLOURS}" + (" default" if method.default else "")
        out.append(f'<path class="{classes}" d="M{x:.0f} {y}h34"'
                   + (f' stroke-dasharray="{dash}"' if dash and not method.default else "") + "/>")
        out.append(marker(index, x + 17, y))
        never = all(axis.badness(c) == 0 for c in axis.cells[method.name])
        note = (" (default)" if method.default else "") + (", never" if never and axis.counts else "")
        strong = ' class="strong"' if method.default else ""
        out.append(f'<text x="{x + 40:.0f}" y="{y + 4}"{strong}>{html.escape(method.name + note)}</text>')
    return out


def curve_svg(axis):
    """The whole picture as text."""
    scales = Scales(axis)
    end = scales.bottom + scales.band + AXIS_TEXT
    height = end + 12 + ROW * math.ceil(len(axis.methods) / 2)
    what = "failure rate" if axis.counts else axis.value
    out = [f'<svg class="plot" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
           f'role="img" aria-label="{html.escape(axis.title)}: {html.escape(what)} of each method">',
           f"<style>{STYLE}</style>",
           f'<rect class="paper" width="{WIDTH}" height="{height}"/>',
           f'<text class="title" x="{LEFT}" y="20">{html.escape(axis.title)}: {html.escape(what)}</text>']
    out += grid(scales)
    order = sorted(range(len(axis.methods)), key=lambda i: axis.methods[i].default)
    for index in order: # defaults on top
        out += curve(scales, index, axis.methods[index])
    out += legend(scales, end + 12)
    return "\n".join(out + ["</svg>"]) + "\n"
