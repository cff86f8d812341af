#!/usr/bin/env python3
"""Writes the stability map of a folder: stability.html, map.svg and curves/AXIS.svg.

    write_page.py FOLDER [--png]

FOLDER holds the stability.json of plumb_stability. --png makes a PNG of each picture too, where
rsvg-convert is installed. Needs Python's standard library alone. Exit codes: 0 done, 1 a method
misses its limit, 2 usage, 4 stability.json cannot be read, 5 a file cannot be written.
"""
import html
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]
from curve_svg import curve_svg  # noqa: E402
from map_svg import map_svg  # noqa: E402
from page_src.files import write  # noqa: E402
from page_src.numbers import power  # noqa: E402
from page_src.style import BASE  # noqa: E402
from results import Results  # noqa: E402

STYLE = BASE + """td.none{border-color:transparent}.l1{background:var(--l1)}.l2{background:var(--l2)}
.l3{background:var(--l3);color:var(--t3)}.l4{background:var(--l4);color:var(--t4)}
.bad{outline:3px solid var(--red);outline-offset:-3px}.red{color:var(--red);font-weight:700}
figure{margin:0;overflow-x:auto}figure svg{width:100%;min-width:34rem;height:auto;max-width:44rem}summary{cursor:pointer}
@media (max-width:40rem){body{padding:.6rem}th,td{padding:.15rem .3rem;font-size:.85rem}}
"""


def describe(axis, cell):
    """A cell in words."""
    at = f"at {power(cell['stress'])}"
    if not axis.counts:
        return f"{axis.shown(axis.badness(cell))} {at}"
    low, high = 100 * cell["low"], 100 * cell["high"]
    return f"{cell['failures']} of {cell['trials']} fail {at} (95 %: {low:.3g} to {high:.3g} %)"


def map_cell(axis, method):
    cell = axis.worst(method)
    worst = axis.badness(cell)
    bad = bool(axis.wrong(method))
    classes = f"l{axis.level(worst)}" + (" bad" if bad else "")
    return (f'<td class="{classes}"><a href="#{axis.name}" title="{html.escape(describe(axis, cell))}">'
            f"{axis.shown(worst)}{axis.mark(method)}</a></td>")


def group_table(name, axes, methods):
    out = [f"<h2>{html.escape(name.capitalize())}</h2>", '<div class="scroll" tabindex="0"><table><tr><td class="none"></td>']
    out += [f'<th scope="col"><a href="#{a.name}" title="{html.escape(a.title)}">{a.name}</a></th>' for a in axes]
    out.append("</tr>")
    for method_name in methods:
        found = {a.name: m for a in axes for m in a.methods if m.name == method_name}
        first = next(iter(found.values()))
        default = any(m.default for m in found.values())
        out.append(f'<tr><th scope="row" class="{"default" if default else ""}" title="{html.escape(first.what)}">'
                   f'{"● " if default else ""}{html.escape(method_name)}</th>')
        out += [map_cell(a, found[a.name]) if a.name in found else '<td class="none"></td>' for a in axes]
        out.append("</tr>")
    return out + ["</table></div>"]


def numbers_table(axis):
    out = ["<details><summary>Numbers</summary>", '<div class="scroll" tabindex="0"><table><tr><th></th>']
    out += [f'<th scope="col">{power(s)}</th>' for s in axis.stresses]
    out.append("</tr>")
    for method in axis.methods:
        out.append(f'<tr><th scope="row">{html.escape(method.name)}</th>')
        for cell in axis.cells[method.name]:
            text = f"{cell['failures']}/{cell['trials']}" if axis.counts else axis.shown(axis.badness(cell))
            out.append(f"<td>{text}</td>")
        out.append("</tr>")
    return out + ["</table></div></details>"]


def axis_section(axis, svg):
    sentence = axis.tested[:1].upper() + axis.tested[1:]
    value = axis.failure.startswith("value: ")
    measure = axis.failure[len("value: "):] if value else axis.failure
    methods = "".join(f"<li>{'<b>' if m.default else ''}{html.escape(m.name)}{'</b>' if m.default else ''}: "
                      f"{html.escape(m.what)}</li>" for m in axis.methods)
    return ([f'<h3 id="{axis.name}">{html.escape(axis.title)} <span class="soft">{axis.name}</span></h3>',
             f"<p>{html.escape(sentence)}. {'Value' if value else 'A failure'}: {html.escape(measure)}. "
             f"Limit of the default: {html.escape(axis.range)}.</p>", f'<figure tabindex="0">{svg}</figure>',
             f"<details><summary>Methods</summary><ul>{methods}</ul></details>"] + numbers_table(axis))


def verdict(results):
    wrong = results.wrong
    if not wrong:
        return ["<p><b>✓ Every default holds its limit over its range.</b></p>"]
    items = "".join(f'<li><a href="#{a.name}">{a.name}</a>: {html.escape(m.name)}: {html.escape(describe(a, c))}</li>'
                    for a, m, c in wrong)
    return [f'<p class="red">✗ A method misses its limit.</p><ul class="red">{items}</ul>']


def page(results, curves):
    data = results.data
    quick = " A quick run: few trials, so small rates are not seen." if data["quick"] else ""
    out = ['<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
           '<meta name="viewport" content="width=device-width, initial-scale=1">',
           f"<title>Where methods fail</title><style>{STYLE}</style></head><body>",
           "<h1>Where methods fail</h1>",
           "<p>Rows are methods, columns are axes of stress. A cell shows the worst failure rate over the axis, or "
           "the worst value where there is nothing to count, and leads to its curve. ● marks what the renderer "
           "does by default; ✓ a method that holds its limit over the range stated with the curve, ✗ one that does "
           "not. Cells of methods with a limit show the worst within that range; * says that the method fails beyond "
           "it.</p>"]
    out += verdict(results)
    out.append(f'<p class="soft">Plumbline {html.escape(data["version"])}, {html.escape(data["cpu"])}, Embree '
               f'{html.escape(data["embree"])}, {html.escape(data["compiler"])}, seed {data["seed"]}.{quick}</p>')
    for name, (axes, methods) in results.groups.items():
        out += group_table(name, axes, methods)
    out.append("<h2>Curves</h2>")
    for axis in results.axes:
        out += axis_section(axis, curves[axis.name])
    return "\n".join(out + ["</body></html>"]) + "\n"


def write_all(folder, png):
    with open(os.path.join(folder, "stability.json"), encoding="utf-8") as file:
        results = Results(file.read())
    curves = {axis.name: curve_svg(axis) for axis in results.axes}
    os.makedirs(os.path.join(folder, "curves"), exist_ok=True)
    pictures = {"map": map_svg(results)} | {f"curves/{name}": svg for name, svg in curves.items()}
    for name, svg in pictures.items():
        path = os.path.join(folder, name + ".svg")
        write(path, svg)
        if png:
            subprocess.run(["rsvg-convert", "-z", "2", "-o", path[:-4] + ".png", path], check=True)
    write(os.path.join(folder, "stability.html"), page(results, curves))
    return results


def main(arguments):
    folders = [a for a in arguments if not a.startswith("-")]
    options = [a for a in arguments if a.startswith("-")]
    if len(folders) != 1 or any(o != "--png" for o in options):
        print("error: expected FOLDER [--png]", file=sys.stderr)
        return 2
    png = "--png" in options
    if png and not shutil.which("rsvg-convert"):
        print("warning: no PNG: rsvg-convert (librsvg2-bin) is not installed", file=sys.stderr)
        png = False
    source = os.path.join(folders[0], "stability.json")
    try:
        results = write_all(folders[0], png)
    except (OSError, subprocess.CalledProcessError) as error:
        path = getattr(error, "filename", None) or folders[0]
        print(f"{path}: error: {getattr(error, 'strerror', None) or error}", file=sys.stderr)
        return 4 if path == source else 5
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        print(f"{source}: error: not the result of plumb_stability ({error})", file=sys.stderr)
        return 4
    return 1 if results.wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
