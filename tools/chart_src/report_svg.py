"""Error against time, log-log, as an SVG that adapts to the reader's light or dark scheme."""
import html
import math

W, H, LEFT, RIGHT, TOP, BOTTOM = 760, 460, 62, 190, 40, 46
STYLE = """text{font:12px system-ui,sans-serif;fill:#222}.paper{fill:#fff}.grid{stroke:#ddd}
.line{fill:none;stroke:#555;stroke-width:1.2}.strong{stroke:#0072b2;stroke-width:3}
.front{fill:none;stroke:#d55e00;stroke-width:2}
@media(prefers-color-scheme:dark){text{fill:#ddd}.paper{fill:#181818}.grid{stroke:#3a3a3a}
.line{stroke:#aaa}.strong{stroke:#56b4e9}.front{stroke:#e69f00}}"""
DASHES = ["", "6 3", "2 3", "8 3 2 3", "12 4", "4 2 1 2"]


def chart(result):
    rows = result["summary"]
    points = [p for r in rows for p in r["points"]]
    spans = []
    for key in ("seconds", "mse"):
        logs = [math.log10(p[key]) for p in points]
        spans.append((math.floor(min(logs)), max(math.floor(min(logs)) + 1, math.ceil(max(logs)))))

    def at(p):
        x = (math.log10(p["seconds"]) - spans[0][0]) / (spans[0][1] - spans[0][0])
        y = (math.log10(p["mse"]) - spans[1][0]) / (spans[1][1] - spans[1][0])
        return LEFT + x * (W - LEFT - RIGHT), H - BOTTOM - y * (H - TOP - BOTTOM)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {W} {H}"><style>{STYLE}</style>'
           f'<rect class="paper" width="{W}" height="{H}"/><text x="{LEFT}" y="22">'
           f'{html.escape(result["name"])}: MSE against seconds; rings: Pareto front</text>']
    for axis, (low, high) in enumerate(spans):
        for power in range(low, high + 1):
            f = (power - low) / (high - low)
            x, y = LEFT + f * (W - LEFT - RIGHT), H - BOTTOM - f * (H - TOP - BOTTOM)
            place = (f'x1="{x}" x2="{x}" y1="{TOP}" y2="{H - BOTTOM}"' if axis == 0
                     else f'x1="{LEFT}" x2="{W - RIGHT}" y1="{y}" y2="{y}"')
            tx, ty = (x, H - BOTTOM + 18) if axis == 0 else (LEFT - 8, y + 4)
            out.append(f'<line class="grid" {place}/><text x="{tx}" y="{ty}" text-anchor='
                       f'"{"middle" if axis == 0 else "end"}">{10.0 ** power:g}</text>')
    label_y = -1e9
    for i, row in sorted(enumerate(rows), key=lambda r: at(r[1]["points"][-1])[1]):
        places = [at(p) for p in row["points"]]
        strong = " strong" if row["method"] in ("default", "worst") else ""
        out.append(f'<polyline class="line{strong}" stroke-dasharray="{DASHES[i % 6]}" points="'
                   + " ".join(f"{x:.1f},{y:.1f}" for x, y in places) + '"/>')
        out += [f'<circle class="front" cx="{x:.1f}" cy="{y:.1f}" r="5"/>'
                for p, (x, y) in zip(row["points"], places) if p["pareto"]]
        x, y = places[-1]
        label_y = max(y, label_y + 14)
        out.append(f'<path class="line" stroke-dasharray="1 3" d="M{x:.1f} {y:.1f}L{W - RIGHT + 4} {label_y - 4:.1f}"/>'
                   f'<text x="{W - RIGHT + 8}" y="{label_y:.1f}">{html.escape(row["method"])}</text>')
    return "\n".join(out) + "</svg>\n"
