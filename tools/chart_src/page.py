"""chart.html: for each scene the picture and the table, in one file without anything from outside."""
import html

from chart_src.accelerator_svg import accelerator_svg
from chart_src.analysis import FIREFLIES, MEASURES, cause
from chart_src.error_svg import drawn, error_svg
from page_src.numbers import power
from page_src.style import BASE

STYLE = BASE + """figure{margin:0}figure svg{width:100%;max-width:36rem;height:auto}
.choice figure{display:none}.choice label{margin-right:1rem;padding:.3rem 0}
.choice input:nth-of-type(1):checked~figure:nth-of-type(1),.choice input:nth-of-type(2):checked~figure:nth-of-type(2),
.choice input:nth-of-type(3):checked~figure:nth-of-type(3){display:block}
table{font-size:.85rem}td{white-space:normal}tr.heads th{white-space:normal}
@media (max-width:40rem){body{padding:.6rem}table,tbody,tr,th[scope=row],td{display:block}tr.heads{display:none}
th,td{border:0;text-align:left;white-space:normal;padding:0}th[scope=row]{text-align:left;font-weight:700;padding:.5rem 0 0}
td::before{content:attr(data-head) ": ";color:var(--soft)}}
"""
HEADS = ["samples a pixel", "1/(MSE·s), 95 %", "slope, 95 %", "time at equal error", "FLIP",
         "error in the worst 0.1 % of pixels", "on the front"]
ACCELERATOR_HEADS = ["million rays a second, 95 %", "rays lost, 95 %", "on the worst axis"]


def span(value):
    """A mean with its interval; one run has none."""
    mean, low, high = value
    return power(mean) + (f" ({power(low)} to {power(high)})" if low is not None else "")


def times(value):
    """The factor of a method against the default."""
    if not value:
        return "–"
    text = f"{power(value['times'])} ×"
    if value["low"] is not None:
        text += f" ({power(value['low'])} to {power(value['high'])})"
    return text + (" *" if value["extrapolated"] else "")


def outliers(share):
    return f"{100 * share:.2g} %"


def cells(row):
    slope = span(row["slope"]) if row["slope"] else "–"
    if row["bend"]:
        slope += f", flatter from {row['bend'][0]} on ({cause(row)})"
    front = ", ".join(str(p["spp"]) for p in row["points"] if "mse" in p["front"])
    last = row["points"][-1]
    return [str(last["spp"]), span(row["efficiency"]), slope, "1" if row["method"] == "default" else times(row["factor"]),
            power(last["flip"]), outliers(row["outlier_share"]), f"◆ {front}" if front else "–"]


def table(first, heads, rows):
    """`rows`: (head, whether it is the default, cells)."""
    out = ['<div class="scroll" tabindex="0"><table>', f'<tr class="heads"><th scope="col">{first}</th>'
           + "".join(f'<th scope="col">{h}</th>' for h in heads) + "</tr>"]
    for head, default, texts in rows:
        strong = ' class="default"' if default else ""
        out.append(f'<tr><th scope="row"{strong}>{html.escape(head)}</th>'
                   + "".join(f'<td data-head="{h}">{c}</td>' for h, c in zip(heads, texts)) + "</tr>")
    return out + ["</table></div>"]


def headline(result):
    """The default against the worst in a sentence, if both were measured."""
    worst = next((r["factor"] for r in result["summary"] if r["method"] == "worst" and r["factor"]), None)
    if not worst:
        return []
    between = f" (95 %: {power(worst['low'])} to {power(worst['high'])})" if worst["low"] is not None else ""
    far = ", extrapolated" if worst["extrapolated"] else ""
    return [f"<p>The worst method takes <b>{power(worst['times'])} times</b>{between} as long as the default "
            f"for a mean squared error of {power(worst['error'])}{far}.</p>"]


def pictures(number, result):
    """One for each measure, of which a reader chooses; the first one is shown."""
    shown = [m for m in MEASURES if drawn(result["summary"], m)]
    inputs = [f'<input type="radio" name="measure{number}" id="{m}{number}"{" checked" if m == shown[0] else ""}>'
              f'<label for="{m}{number}">{MEASURES[m]}</label>' for m in shown]
    return ['<div class="choice">', *inputs, *(f"<figure>{error_svg(result, m)}</figure>" for m in shown), "</div>"]


def scene(number, result):
    out = [f'<h2>{html.escape(result["name"])}</h2>']
    if not result["summary"]:
        return out + ["<p>Nothing that stands above the noise of the reference.</p>"]
    rows = [(r["method"], r["method"] == "default", cells(r)) for r in result["summary"]]
    reference = result["reference"]
    return (out + headline(result) + pictures(number, result) + table("method", HEADS, rows)
            + [f'<p class="soft">Reference: {reference["spp"]} samples a pixel, its own error '
               f'{power(reference["mse"])} taken off. FLIP has nothing taken off: half of the reference against '
               f'the whole has {power(reference["flip"])}. * extrapolated along the curve.</p>'])


def accelerators(data):
    out = ["<h2>Accelerators: speed and failures</h2>"]
    if not data["points"]:
        return out + [f'<p>Not drawn: {html.escape(data["why"])}.</p>']
    rows = []
    for p in data["points"]:
        speed = p["mrays_per_s"]
        lost = (f"{power(p['rate'])} ({power(p['low'])} to {power(p['high'])})" if p["failures"]
                else f"none of {power(p['trials'])}, so below {power(p['high'])}")
        rows.append((p["name"], False, [span([speed["mean"], speed["low"], speed["high"]]), lost,
                                        f"{power(p['worst_rate'])} ({p['worst_axis']})" if p["failures"] else "–"]))
    cpus = dict.fromkeys((data["speed_cpu"], data["failure_cpu"]))
    return out + ["<p>How many rays a second an accelerator traces, and which share of rays at edges and vertices of "
                  "closed meshes it loses though none can pass: down and to the right is better. Who lost none lies "
                  "in the band below, the bar above being the upper limit of its rate (95 %). The circle marks who is "
                  "beaten by no other in both. Möller–Trumbore is counted alone, without a tree that might lose "
                  "more.</p>", f"<figure>{accelerator_svg(data)}</figure>",
                  *table("accelerator", ACCELERATOR_HEADS, rows),
                  f'<p class="soft">Speed: single rays, geometric mean of {data["cells"]} meshes and kinds of rays '
                  f'(tools/bench). Failures: all axes of triangles (tools/stability). Embree '
                  f'{html.escape(data["embree"])}; measured on {html.escape(" and ".join(cpus))}.</p>']


def page(data):
    out = ['<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
           '<meta name="viewport" content="width=device-width, initial-scale=1">',
           f"<title>Error against time</title><style>{STYLE}</style></head><body>", "<h1>Error against time</h1>",
           "<p>Each curve is one way of rendering: the default of the renderer, the default with one thing changed, "
           "or all things changed to the worst or the textbook's. Further down and further left is better; the grey "
           "band joins what no other point beats in both (the Pareto front). The dotted line is what random samples "
           "do: slope −1. Time is that of rendering, without loading and building.</p>"]
    if not data["complete"]:
        out.append("<p><b>Stopped before its end:</b> this is what was measured until then.</p>")
    if data["seeds"] == 1:
        out.append("<p><b>One seed:</b> no intervals.</p>")
    out.append(f'<p class="soft">{html.escape(data["renderer"])}, {html.escape(data["cpu"])}, '
               f'{data["threads"]} thread{"s" * (data["threads"] > 1)}, {data["width"]} pixels a side, '
               f'{data["seeds"]} seeds, {data["clock"]} clock</p>')
    for number, result in enumerate(data["scenes"]):
        out += scene(number, result)
    out.append("<p>1/(MSE·s) is at the most samples that the method got to, and so is FLIP; slope is that of the error "
               "over the samples a pixel, one fit a seed, and where it becomes flatter the cause is named: fireflies "
               f"where {100 * FIREFLIES:g} % of the squared error and more sit in 0.1 % of the pixels, else bias; time at "
               "equal error is against the default; the front is that of the mean squared error.</p>")
    out += accelerators(data["accelerators"])
    return "\n".join(out + ["</body></html>"]) + "\n"
