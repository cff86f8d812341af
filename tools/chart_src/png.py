"""The same pictures as PNG, drawn by matplotlib: for places that show no SVG."""
import importlib.util
import io

from chart_src.analysis import MEASURES
from chart_src.error_svg import drawn, short

SIZE, DPI = (7.2, 5.4), 140
COLOURS = ["#0072b2", "#c44e00", "#00805c", "#a8457f", "#8f6000", "#2f8fc4", "#222222", "#777777"]
MARKERS = "os^vD<"  # filled, from the seventh on hollow, from the thirteenth on with a cross in them
DASHES = ["-", (0, (6, 2)), (0, (2, 2)), (0, (6, 2, 1, 2)), (0, (10, 3)), (0, (3, 1, 1, 1))]


def available():
    return importlib.util.find_spec("matplotlib") is not None


def look(index):
    """Marker and dashes differ for thirty-six, whatever the colours."""
    ring = index // len(MARKERS)
    return {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)],
            "markerfacecolor": [None, "white", "white"][min(ring, 2)] or COLOURS[index % len(COLOURS)],
            "linestyle": DASHES[(index + ring) % len(DASHES)], "markersize": 5 if ring < 2 else 8}


def canvas():
    """(figure, axes) on white, both scales logarithmic; of no window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    figure = Figure(figsize=SIZE, dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, color="#dddddd", linewidth=0.6)
    return figure, axes


def bytes_of(figure):
    """Without a date: the same picture is the same file."""
    out = io.BytesIO()
    figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def error_png(result, measure):
    figure, axes = canvas()
    rows = drawn(result["summary"], measure)
    front = sorted((p["seconds"], p[measure]) for _, _, own in rows for p in own if measure in p["front"])
    axes.plot(*zip(*front), color="#888888", alpha=0.35, linewidth=11, solid_capstyle="round", label="Pareto front", zorder=1)
    for index, row, own in rows:
        default = row["method"] == "default"
        axes.plot([p["seconds"] for p in own], [p[measure] for p in own], **look(index), zorder=3 if default else 2,
                  linewidth=2.6 if default else 1.2, label=short(row["method"]))
    axes.set(title=f"{result['name']}: {MEASURES[measure]}", xlabel="seconds of rendering", ylabel=MEASURES[measure])
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False, fontsize=9, handlelength=3.6)
    return bytes_of(figure)


def accelerator_png(data):
    """Who lost no ray hangs at the upper limit of its rate, with an arrow down."""
    figure, axes = canvas()
    for index, p in enumerate(data["points"]):
        speed, rate = p["mrays_per_s"]["mean"], p["rate"] or p["high"]
        style = {**look(index), "linestyle": "", "markersize": 8}
        axes.plot([speed], [rate], **style, label=p["name"] + ("" if p["failures"] else ", none seen"))
        if not p["failures"]:
            axes.annotate("", (speed, rate / 4), (speed, rate), arrowprops={"arrowstyle": "->", "color": style["color"]})
    lowest = min(p["rate"] or p["high"] for p in data["points"])
    axes.set_ylim(lowest / 8, 2)
    axes.set(title="Accelerators: share of hard rays lost", xlabel="million rays a second",
             ylabel="share lost; ↓ upper limit (95 %)")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False, fontsize=9)
    return bytes_of(figure)
