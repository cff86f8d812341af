"""chart.html: for each scene the picture and the table, in one file without anything from outside."""
import html

from chart_src.error_svg import error_svg
from page_src.numbers import power
from page_src.style import BASE

STYLE = BASE + """figure{margin:0}figure svg{width:100%;max-width:36rem;height:auto}
table{font-size:.85rem}tr.heads th{white-space:normal}
@media (max-width:40rem){body{padding:.6rem}table,tbody,tr,th[scope=row],td{display:block}tr.heads{display:none}
th,td{border:0;text-align:left;white-space:normal;padding:0}th[scope=row]{text-align:left;font-weight:700;padding:.5rem 0 0}
td::before{content:attr(data-head) ": ";color:var(--soft)}}
"""
HEADS = ["samples a pixel", "1/(MSE·s), 95 %", "slope, 95 %", "time at equal error", "on the front"]


def span(value):
    """A mean with its interval; one run has none."""
    mean, low, high = value
    return power(mean) + (f" ({power(low)} to {power(high)})" if low is not None else "")


def cells(row):
    slope = span(row["slope"]) if row["slope"] else "–"
    if row["bend"]:
        slope += f", flatter from {row['bend'][0]} on"
    if row["method"] == "default":
        factor = "1"
    elif row["factor"]:
        factor = f"{row['factor']['times']:.3g} ×" + (" *" if row["factor"]["extrapolated"] else "")
    else:
        factor = "–"
    front = ", ".join(str(p["spp"]) for p in row["points"] if p["pareto"])
    return [str(row["points"][-1]["spp"]), span(row["efficiency"]), slope, factor, f"◆ {front}" if front else "–"]


def table(result):
    out = ['<div class="scroll" tabindex="0"><table>', '<tr class="heads"><th scope="col">method</th>'
           + "".join(f'<th scope="col">{h}</th>' for h in HEADS) + "</tr>"]
    for row in result["summary"]:
        strong = ' class="default"' if row["method"] == "default" else ""
        out.append(f'<tr><th scope="row"{strong}>{html.escape(row["method"])}</th>'
                   + "".join(f'<td data-head="{h}">{c}</td>' for h, c in zip(HEADS, cells(row))) + "</tr>")
    return out + ["</table></div>"]


def headline(result):
    """The default against the worst in a sentence, if both were measured."""
    worst = next((r for r in result["summary"] if r["method"] == "worst" and r["factor"]), None)
    if not worst:
        return []
    far = " (extrapolated)" if worst["factor"]["extrapolated"] else ""
    return [f"<p>The worst method takes <b>{worst['factor']['times']:.3g} times</b> as long as the default "
            f"for a mean squared error of {power(worst['factor']['error'])}{far}.</p>"]


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
    for result in data["scenes"]:
        out.append(f'<h2>{html.escape(result["name"])}</h2>')
        if not result["summary"]:
            out.append("<p>Nothing that stands above the noise of the reference.</p>")
            continue
        out += headline(result) + [f"<figure>{error_svg(result)}</figure>"] + table(result)
        out.append(f'<p class="soft">Reference: {result["reference"]["spp"]} samples a pixel, its own error '
                   f'{power(result["reference"]["mse"])} taken off. * extrapolated along the curve.</p>')
    out.append("<p>1/(MSE·s) is at the most samples that the method got to; slope is that of the error over "
               "the samples a pixel, one fit a seed; time at equal error is against the default.</p>")
    return "\n".join(out + ["</body></html>"]) + "\n"
