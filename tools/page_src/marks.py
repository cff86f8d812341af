"""What tells curves apart without colour: markers and dashes; the style of a plot, light and dark."""

COLOURS = 8
STYLE = """
.plot text{font:12px system-ui,sans-serif;fill:#222}.plot .title{font-weight:600;font-size:14px}
.plot .small{font-size:11px}.plot .strong{font-weight:700}
.plot .grid{stroke:#ddd}.plot .frame{stroke:#666;fill:none}.plot .limit{stroke:#222;stroke-dasharray:2 3}
.plot .band{fill:#f3f3f3}.plot .paper{fill:#fff}
.plot .curve{fill:none;stroke-width:1.6}.plot .default{stroke-width:3}
.plot .c0{stroke:#0072b2}.plot .c1{stroke:#c44e00}.plot .c2{stroke:#00805c}.plot .c3{stroke:#a8457f}
.plot .c4{stroke:#8f6000}.plot .c5{stroke:#2f8fc4}.plot .c6{stroke:#222}.plot .c7{stroke:#777}
.plot .f0{fill:#0072b2}.plot .f1{fill:#c44e00}.plot .f2{fill:#00805c}.plot .f3{fill:#a8457f}
.plot .f4{fill:#8f6000}.plot .f5{fill:#2f8fc4}.plot .f6{fill:#222}.plot .f7{fill:#777}.plot .hollow{fill:#fff}
@media (prefers-color-scheme:dark){
.plot text{fill:#ddd}.plot .grid{stroke:#3a3a3a}.plot .frame{stroke:#999}.plot .limit{stroke:#ddd}
.plot .band{fill:#262626}.plot .paper,.plot .hollow{fill:#181818}
.plot .c0{stroke:#4aa8e0}.plot .c1{stroke:#f08a45}.plot .c2{stroke:#3fc79a}.plot .c3{stroke:#e08fbf}
.plot .c4{stroke:#d9a437}.plot .c5{stroke:#8fd0f5}.plot .c6{stroke:#eee}.plot .c7{stroke:#aaa}
.plot .f0{fill:#4aa8e0}.plot .f1{fill:#f08a45}.plot .f2{fill:#3fc79a}.plot .f3{fill:#e08fbf}
.plot .f4{fill:#d9a437}.plot .f5{fill:#8fd0f5}.plot .f6{fill:#eee}.plot .f7{fill:#aaa}}
"""
DASHES = ["", "7 3", "2 3", "9 3 2 3", "12 4", "4 2 1 2", "1 2", "6 2 2 2 2 2", "14 3 3 3", "3 5",
          "8 6", "10 2 1 2 1 2", "5 5"]
# Polygons of about radius 4; one letter a name.
SHAPES = [None, [(-3.5, -3.5), (3.5, -3.5), (3.5, 3.5), (-3.5, 3.5)], [(0, -4.5), (4.2, 3), (-4.2, 3)],
          [(0, 4.5), (4.2, -3), (-4.2, -3)], [(0, -5), (4, 0), (0, 5), (-4, 0)],
          [(-4.5, 0), (3, -4.2), (3, 4.2)]]


def marker(index, x, y):
    """A filled shape, from the seventh on a hollow one, from the thirteenth on one with a cross: eighteen differ."""
    shape, fill = SHAPES[index % len(SHAPES)], "hollow" if index >= len(SHAPES) else f"f{index % COLOURS}"
    if index >= 2 * len(SHAPES):
        cross = f'<path class="c{index % COLOURS}" d="M{x - 6:.1f} {y:.1f}h12M{x:.1f} {y - 6:.1f}v12"/>'
        return cross + marker(index - len(SHAPES), x, y)
    classes = f'class="c{index % COLOURS} {fill}"'
    if shape is None:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.6" {classes}/>'
    points = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in shape)
    return f'<polygon points="{points}" {classes}/>'
