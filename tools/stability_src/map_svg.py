"""The whole map as one SVG: a block for each group, rows methods, columns axes."""
import html

HEAD, ROW, COLUMN, NAMES, GAP = 46, 20, 92, 178, 22
STYLE = """
.map text{font:12px system-ui,sans-serif;fill:#222}.map .group{font-weight:700;font-size:14px}
.map .strong{font-weight:700}.map .paper{fill:#fff}.map .cell{stroke:#bbb}
.map .l0{fill:#fff}.map .l1{fill:#fdebd3}.map .l2{fill:#f9c188}.map .l3{fill:#e9832f}.map .l4{fill:#8c2d04}
.map .t4{fill:#fff}.map .bad{stroke:#c00000;stroke-width:3}
@media (prefers-color-scheme:dark){
.map text{fill:#ddd}.map .paper{fill:#181818}.map .cell{stroke:#555}
.map .l0{fill:#181818}.map .l1{fill:#3a2714}.map .l2{fill:#69400f}.map .l3{fill:#ad5d12}.map .l4{fill:#ffb366}
.map .t4{fill:#111}.map .t3{fill:#fff}.map .bad{stroke:#ff6b6b}}
"""


def block_height(methods):
    return HEAD + ROW * len(methods) + GAP


def cell_svg(axis, method, x, y):
    worst = axis.badness(axis.worst(method))
    level = axis.level(worst)
    bad = bool(axis.wrong(method))
    return (f'<rect class="cell l{level}{" bad" if bad else ""}" x="{x}" y="{y}" width="{COLUMN}" '
            f'height="{ROW}"/><text class="t{level}" x="{x + COLUMN / 2}" y="{y + 14}" '
            f'text-anchor="middle">{axis.shown(worst)}{axis.mark(method)}</text>')


def block(name, axes, methods, left, top):
    out = [f'<text class="group" x="{left}" y="{top + 16}">{html.escape(name)}</text>']
    for column, axis in enumerate(axes):
        x = left + NAMES + COLUMN * column
        out.append(f'<text x="{x + COLUMN / 2}" y="{top + HEAD - 8}" text-anchor="middle">'
                   f'{html.escape(axis.name)}</text>')
    for row, method_name in enumerate(methods):
        y = top + HEAD + ROW * row
        found = [(c, a, m) for c, a in enumerate(axes) for m in a.methods if m.name == method_name]
        default = any(m.default for _, _, m in found)
        strong = ' class="strong"' if default else ""
        out.append(f'<text x="{left + NAMES - 8}" y="{y + 14}" text-anchor="end"{strong}>'
                   f'{"● " if default else ""}{html.escape(method_name)}</text>')
        for column, axis, method in found:
            out.append(cell_svg(axis, method, left + NAMES + COLUMN * column, y))
    return out


def columns_of(groups):
    """Groups in two columns of about the same height, in order."""
    heights = [block_height(methods) for _, (_, methods) in groups]
    best = min(range(len(groups) + 1),
               key=lambda i: max(sum(heights[:i]), sum(heights[i:])))
    return [c for c in (groups[:best], groups[best:]) if c]


def map_svg(results):
    columns = columns_of(list(results.groups.items()))
    out, left, height = [], 12, 0
    for column in columns:
        top = 8
        for name, (axes, methods) in column:
            out += block(name, axes, methods, left, top)
            top += block_height(methods)
        height = max(height, top)
        left += NAMES + COLUMN * max(len(axes) for _, (axes, _) in column) + 20
    note = ("Worst over each axis; with ✓ over the range of the method's limit (✓*: it fails beyond). "
            "● is what the renderer does by default.")
    out.append(f'<text x="12" y="{height + 12}">{note}</text>')
    return "\n".join(
        [f'<svg class="map" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left} {height + 24}" '
         'role="img" aria-label="Worst failure rate of each method on each axis">',
         f"<style>{STYLE}</style>", f'<rect class="paper" width="{left}" height="{height + 24}"/>']
        + out + ["</svg>"]) + "\n"
