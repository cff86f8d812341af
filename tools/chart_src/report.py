"""What a run leaves in its folder: chart.json, chart.html, the pictures; how it goes on from an earlier one."""
import functools
import json
import os

from chart_src import accelerators, analysis, png
from chart_src.accelerator_svg import accelerator_svg
from chart_src.error_svg import drawn, error_svg
from chart_src.page import page
from page_src.files import write


def cpu_model():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown")


def pictures_of(table):
    """(name, SVG, what draws the same with matplotlib) of everything that there is to draw."""
    for r in table["scenes"]:
        for measure in analysis.MEASURES:
            if drawn(r["summary"], measure):
                name = r["name"] + ("" if measure == "mse" else "-" + measure)
                yield name, error_svg(r, measure), functools.partial(png.error_png, r, measure)
    if table["accelerators"]["points"]:
        data = table["accelerators"]
        yield "accelerators", accelerator_svg(data), functools.partial(png.accelerator_png, data)


def setting(o, version):
    """What has to be the same for scenes that share a page."""
    return {"renderer": version, "cpu": cpu_model(), "clock": o.clock, "threads": o.threads, "width": o.width,
            "seeds": o.seeds}


def earlier(o, version):
    """The chart.json that --add continues; InputError where it cannot be continued."""
    path = os.path.join(o.out, "chart.json")
    if not o.add or not os.path.exists(path):
        return {"scenes": [], "methods": [], "complete": True}
    table = accelerators.load(path)
    for key, value in setting(o, version).items():
        if not isinstance(table, dict) or table.get(key) != value or "scenes" not in table:
            found = table.get(key) if isinstance(table, dict) else table
            raise accelerators.InputError(f"{path}: error: --add: another {key} (got '{found}', expected '{value}')")
    return table


def merged(before, now):
    """Entries by name: those of `now` in the place of those of `before`, new ones last."""
    fresh = {entry["name"]: entry for entry in now}
    return [fresh.pop(entry["name"], entry) for entry in before] + list(fresh.values())


def rounded(value):
    """The same with all floating-point numbers to seven digits."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(each) for each in value]
    return float(f"{value:.7g}") if isinstance(value, float) else value


def json_text(value, depth=3):
    """JSON whose outer levels have a line for each entry."""
    if depth == 0 or not value or not isinstance(value, (dict, list)):
        return json.dumps(value, ensure_ascii=False)
    pad = "\n" + " " * (4 - depth)
    if isinstance(value, dict):
        return "{" + ",".join(f"{pad}{json.dumps(k)}: {json_text(v, depth - 1)}" for k, v in value.items()) + "}"
    return "[" + ",".join(pad + json_text(v, depth if depth == 2 else depth - 1) for v in value) + "]"


def write_all(o, version, before, results, second, complete):
    """Writes everything; nothing where nothing was measured."""
    results = [r for r in results if r["runs"]]
    for r in results:
        r["summary"] = analysis.summary(r["runs"])
    if not results:
        return
    table = {**setting(o, version), "time_s": o.time, "complete": complete and before["complete"],
             "scenes": merged(before["scenes"], results), "accelerators": second,
             "methods": merged(before["methods"], [{"name": m.name, "choices": m.choices} for m in o.chosen])}
    write(os.path.join(o.out, "chart.json"), json_text(rounded(table)) + "\n")
    write(os.path.join(o.out, "chart.html"), page(table))
    for name, svg, draw in pictures_of(table):
        write(os.path.join(o.out, name + ".svg"), svg)
        if png.available():
            write(os.path.join(o.out, name + ".png"), draw())
    for r in results:
        if r["summary"]:
            print(analysis.text(r))


def second_chart(o):
    """Its numbers; no points, and why, where there is nothing to compare."""
    bench = o.bench or accelerators.widest(o.results)
    stability = o.stability or next(iter(accelerators.results(o.results, "stability")), None)
    if not bench or not stability:
        return {"points": [], "why": "no results of tools/bench and tools/stability"}
    second = accelerators.compare(accelerators.load(bench), accelerators.load(stability))
    return second if second["points"] else {"points": [], "why": "tools/bench and tools/stability share no accelerator"}
