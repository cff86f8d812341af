"""Error against time, log-log, as an SVG: a curve for each method, named at its end.

As wide as a phone, so that its letters stay readable there. Curves differ by marker and dashes as
well as by colour; the Pareto front lies under them as a broad band.
"""
import html
import math

from chart_src.analysis import MEASURES
from page_src.marks import COLOURS, DASHES, STYLE, marker
from page_src.numbers import power

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 360, 400, 42, 114, 26, 40
LETTERS = 11  # pixels between the names
OWN_STYLE = """
.plot text{font-size:10px}.plot .title{font-size:12px}.plot .curve{stroke-width:1.1}.plot .default{stroke-width:2.4}
.plot .lead{stroke:#999;stroke-width:.6}.plot .front{fill:none;stroke:#888;stroke-opacity:.35;stroke-width:11;
stroke-linecap:round;stroke-linejoin:round}.plot .guide{stroke:#777;stroke-dasharray:1 3;fill:none}
"""


class Scale:
    """Logarithmic, from `low` to `high` onto `begin` to `end`."""

    def __init__(self, values, begin, end):
        pad = 0.06 * max(math.log10(max(values) / min(values)), 0.3)
        self.low, self.high = math.log10(min(values)) - pad, math.log10(max(values)) + pad
        self.begin, self.end = begin, end

    def __call__(self, value):
        return self.begin + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        steps = (1,) if self.high - self.low > 2 else (1, 2, 5)
        ticks = [m * 10.0 ** k for k in range(math.floor(self.low), math.ceil(self.high)) for m in steps]
        return [t for t in ticks if self.low <= math.log10(t) <= self.high]


def short(name):
    """A method's name where there is little room."""
    key, _, value = name.partition("=")
    return {"rr": f"RR {value}", "estimator": f"{value} only", "light-sampling": f"light {value}",
            "reuse": f"reuse {value}"}.get(key, value or name)


def spread(wanted, low, high):
    """Places at least LETTERS apart, near the `wanted` ones (ascending), from `low` to `high`."""
    places = []
    for y in wanted:
        places.append(max(y, places[-1] + LETTERS if places else low))
    limit = high
    for i in reversed(range(len(places))):
        places[i] = min(places[i], limit)
        limit = places[i] - LETTERS
    return places


def drawn(summary, measure):
    """(index, row, its points) of each method with something above 0 to draw."""
    rows = [(i, row, [p for p in row["points"] if p[measure] > 0]) for i, row in enumerate(summary)]
    return [r for r in rows if r[2]]


def grid(x, y):
    out = []
    for t in x.ticks():
        out.append(f'<path class="grid" d="M{x(t):.1f} {TOP}V{HEIGHT - BOTTOM}"/>'
                   f'<text x="{x(t):.1f}" y="{HEIGHT - BOTTOM + 14}" text-anchor="middle">{power(t)}</text>')
    for t in y.ticks():
        out.append(f'<path class="grid" d="M{LEFT} {y(t):.1f}H{WIDTH - RIGHT}"/>'
                   f'<text x="{LEFT - 5}" y="{y(t) + 3:.1f}" text-anchor="end">{power(t)}</text>')
    return out + [f'<rect class="frame" x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" '
                  f'height="{HEIGHT - TOP - BOTTOM}"/>',
                  f'<text x="{(LEFT + WIDTH - RIGHT) / 2:.0f}" y="{HEIGHT - 8}" text-anchor="middle">'
                  "seconds of rendering</text>"]


def guide(x, y, first):
    """What random samples do: the error falls as 1 over the time, from the default's first point."""
    s, e = first
    least = max(10 ** y.low, e * s / 10 ** x.high)
    return [f'<path class="guide" d="M{x(s):.1f} {y(e):.1f}L{x(s * e / least):.1f} {y(least):.1f}">'
            "<title>error ∝ 1/time</title></path>"]


def curve(index, name, places):
    strong = " default" if name == "default" else ""
    dash = DASHES[index % len(DASHES)]
    line = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
    out = [f'<g><title>{html.escape(name)}</title><path class="curve c{index % COLOURS}{strong}" d="{line}"'
           + (f' stroke-dasharray="{dash}"' if dash else "") + "/>"]
    return out + [f'<g transform="translate({a:.1f} {b:.1f}) scale(.62)">{marker(index, 0, 0)}</g>'
                  for a, b in places] + ["</g>"]


def names(ends):
    """`ends`: (index, name, place of the curve's last point)."""
    out, left = [], WIDTH - RIGHT + 10
    ends = sorted(ends, key=lambda end: end[2][1])
    for (index, name, (a, b)), place in zip(ends, spread([end[2][1] for end in ends], TOP + 4, HEIGHT - BOTTOM - 2)):
        strong = ' class="strong"' if name == "default" else ""
        out.append(f'<path class="lead" d="M{a:.1f} {b:.1f}L{left - 2} {place:.1f}"/>'
                   f'<g transform="translate({left + 4} {place:.1f}) scale(.75)">{marker(index, 0, 0)}</g>'
                   f'<text x="{left + 11}" y="{place + 3:.1f}"{strong}>{html.escape(short(name))}</text>')
    return out


def error_svg(result, measure="mse"):
    """The whole picture as text."""
    rows = drawn(result["summary"], measure)
    points = [p for _, _, own in rows for p in own]
    x = Scale([p["seconds"] for p in points], LEFT, WIDTH - RIGHT)
    y = Scale([p[measure] for p in points], HEIGHT - BOTTOM, TOP)
    name, what = html.escape(result["name"]), MEASURES[measure]
    out = [f'<svg class="plot" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
           f'aria-label="{name}: {what} against seconds, a curve for each method">',
           f"<style>{STYLE}{OWN_STYLE}</style>", f'<rect class="paper" width="{WIDTH}" height="{HEIGHT}"/>',
           f'<text class="title" x="{LEFT}" y="16">{name}: {what}</text>']
    out += grid(x, y)
    front = sorted((p["seconds"], p[measure]) for p in points if measure in p["front"])
    out.append('<path class="front" d="M' + "L".join(f"{x(s):.1f} {y(e):.1f}" for s, e in front)
               + '"><title>Pareto front</title></path>')
    if measure != "flip":  # which is no variance
        out += [line for _, row, own in rows if row["method"] == "default"
                for line in guide(x, y, (own[0]["seconds"], own[0][measure]))]
    ends = []
    for index, row, own in sorted(rows, key=lambda r: r[1]["method"] == "default"):  # the default on top
        places = [(x(p["seconds"]), y(p[measure])) for p in own]
        out += curve(index, row["method"], places)
        ends.append((index, row["method"], places[-1]))
    return "\n".join(out + names(ends) + ["</svg>"]) + "\n"
