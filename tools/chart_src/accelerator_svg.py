"""The accelerators' failure rate against speed, log-log, as an SVG; who never failed lies in a band of its
own below, a lane each, with the upper limit of its rate as a bar.
"""
import html

from chart_src.error_svg import Scale
from page_src.marks import STYLE, marker
from page_src.numbers import power

WIDTH, LEFT, RIGHT, TOP, PLOT, LANE, BELOW = 360, 50, 10, 26, 210, 16, 40
LETTER, LINE = 6.2, 12  # a letter's width at most, a line's height
OWN_STYLE = """
.plot text{font-size:10px}.plot .title{font-size:12px}.plot .lead{stroke:#999;stroke-width:.6}
.plot .limit{stroke-dasharray:none;stroke-width:.8}.plot .halo{fill:#888;fill-opacity:.35}
"""


def none_seen(points):
    """Fastest last, each with a lane."""
    return sorted((i for i, p in enumerate(points) if p["failures"] == 0), key=lambda i: points[i]["mrays_per_s"]["mean"])


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def label_box(x, y, width, side, rise):
    left = x + 9 if side > 0 else x - 9 - width
    return left, y - LINE / 2 - rise, left + width, y + LINE / 2 - rise


def place_labels(places, texts, bars, frame):
    """A box for each text beside its place, or higher or lower, that meets no other, no marker and no bar."""
    taken, out = [(x - 5, y - 5, x + 5, y + 5) for x, y in places] + bars, []
    for (x, y), text in zip(places, texts):
        width = LETTER * len(text)
        boxes = [label_box(x, y, width, side, sign * step * LINE / 2)
                 for step in range(24) for sign in (1, -1) for side in (1, -1)]
        inside = [b for b in boxes if b[0] >= frame[0] and b[1] >= frame[1] and b[2] <= frame[2] and b[3] <= frame[3]]
        box = next((b for b in inside if not any(overlap(b, t) for t in taken)), inside[0] if inside else boxes[0])
        taken.append(box)
        out.append(box)
    return out


def grid(x, y, bottom, end):
    out = []
    for t in x.ticks():
        out.append(f'<path class="grid" d="M{x(t):.1f} {TOP}V{end}"/>'
                   f'<text x="{x(t):.1f}" y="{end + 14}" text-anchor="middle">{power(t)}</text>')
    for t in y.ticks():
        out.append(f'<path class="grid" d="M{LEFT} {y(t):.1f}H{WIDTH - RIGHT}"/>'
                   f'<text x="{LEFT - 5}" y="{y(t) + 3:.1f}" text-anchor="end">{power(t)}</text>')
    if end > bottom:
        middle = (bottom + end) / 2
        out.append(f'<rect class="band" x="{LEFT}" y="{bottom}" width="{WIDTH - RIGHT - LEFT}" height="{end - bottom}"/>'
                   f'<text x="{LEFT - 5}" y="{middle - 3}" text-anchor="end">none</text>'
                   f'<text x="{LEFT - 5}" y="{middle + 9}" text-anchor="end">seen</text>')
    return out + [f'<rect class="frame" x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{end - TOP}"/>',
                  f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{end + 30}" text-anchor="middle">'
                  "million rays a second</text>"]


def point(index, p, place, limit_y):
    x, y = place
    told = f"{p['failures']} of {p['trials']} rays lost" + (f"; below {power(p['high'])} (95 %)" if not p["failures"] else "")
    out = [f'<g><title>{html.escape(p["name"])}: {told}</title>']
    if p["pareto"]:
        out.append(f'<circle class="halo" cx="{x:.1f}" cy="{y:.1f}" r="9"/>')
    if limit_y is not None:
        out.append(f'<path class="limit" d="M{x:.1f} {limit_y:.1f}V{y - 6:.1f}M{x - 4:.1f} {limit_y:.1f}h8"/>')
    return out + [marker(index, x, y), "</g>"]


def label(text, place, box):
    x, y = place
    middle = (box[1] + box[3]) / 2
    out = []
    if abs(middle - y) > LINE / 2 + 1:
        near = box[0] if box[0] > x else box[2]
        out.append(f'<path class="lead" d="M{x:.1f} {y:.1f}L{near:.1f} {middle:.1f}"/>')
    anchor, at = ("start", box[0]) if box[0] > x else ("end", box[2])
    return out + [f'<text x="{at:.1f}" y="{middle + 3.5:.1f}" text-anchor="{anchor}">{html.escape(text)}</text>']


def accelerator_svg(data):
    """The whole picture as text."""
    points = data["points"]
    never = none_seen(points)
    bottom = TOP + PLOT
    end = bottom + (LANE * len(never) + 6 if never else 0)
    x = Scale([p["mrays_per_s"]["mean"] for p in points], LEFT, WIDTH - RIGHT)
    y = Scale([p["rate"] or p["high"] for p in points] + [1.0], bottom, TOP)
    places = [(x(p["mrays_per_s"]["mean"]),
               bottom + LANE * (never.index(i) + 0.5) + 3 if i in never else y(p["rate"])) for i, p in enumerate(points)]
    out = [f'<svg class="plot" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {end + BELOW}" role="img" '
           'aria-label="Share of rays lost against million rays a second, a point for each accelerator">',
           f"<style>{STYLE}{OWN_STYLE}</style>", f'<rect class="paper" width="{WIDTH}" height="{end + BELOW}"/>',
           f'<text class="title" x="{LEFT}" y="16">Accelerators: share of hard rays lost</text>']
    out += grid(x, y, bottom, end)
    for i, p in enumerate(points):
        out += point(i, p, places[i], y(p["high"]) if i in never else None)
    bars = [(places[i][0] - 4, y(points[i]["high"]) - 1, places[i][0] + 4, places[i][1]) for i in never]
    boxes = place_labels(places, [p["name"] for p in points], bars, (LEFT + 2, TOP, WIDTH - RIGHT, end))
    for p, place, box in zip(points, places, boxes):
        out += label(p["name"], place, box)
    return "\n".join(out + ["</svg>"]) + "\n"
