"""Speed of the accelerators, from the JSON of tools/bench, against how often they lose a ray, from that
of tools/stability."""
import glob
import json
import math
import os
import re

import numpy as np

from chart_src import statistics as st

# Configuration of the benchmark, the method of the stability map whose failures are its own, its name.
# Only single rays of `medium` trees, as the map measures them.
KINDS = [
    (r"naive", "naive", "naive"),
    (r"naive/mt", "moeller-trumbore-float", "naive, Möller–T."),
    (r"sah/medium/(\w+)", r"sah-\1", r"SAH \1"),
    (r"sah/medium/(\w+)/mt", "moeller-trumbore-float", r"SAH \1, Möller–T."),
    (r"embree/medium/default", "embree-default", "Embree default"),
    (r"embree/medium/robust", "embree-robust", "Embree robust"),
]
GROUP = "triangles"  # the axes of the map that accelerators are put through


class InputError(Exception):
    """A file of results cannot be used."""


def results(folder, kind):
    """The JSON files of `kind` (bench, stability) in a folder of results, by name."""
    return sorted(glob.glob(os.path.join(folder, kind + "-*.json")))


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise InputError(f"{path}: error: cannot open: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: error: not JSON ({error})") from error


def kind_of(config):
    """(method of the map, name) of a configuration, or None."""
    for pattern, method, name in KINDS:
        match = re.fullmatch(pattern, config)
        if match:
            return match.expand(method), match.expand(name)
    return None


def speeds_of(bench):
    """{configuration: (mean, low, high)} in million rays a second: the geometric mean over the meshes and
    kinds of rays that all of them traced; the interval over the repetitions."""
    cells = [{e["config"]: e["mrays_per_s"] for e in cell["entries"] if kind_of(e["config"])}
             for mesh in bench["meshes"] for cell in mesh["cells"]]
    known = list(dict.fromkeys(config for cell in cells for config in cell))
    cells = [cell for cell in cells if len(cell) == len(known)]
    if not cells:
        return {}, 0
    repetitions = min(len(v) for cell in cells for v in cell.values())
    return {config: st.geometric_interval([math.exp(np.mean([math.log(cell[config][i]) for cell in cells]))
                                           for i in range(repetitions)]) for config in known}, len(cells)


def failures_of(stability):
    """{method: rate over all axes and stresses, its interval, the worst axis}; for no failure at all the
    one-sided limit."""
    counted = {a["name"] for a in stability["axes"] if a["group"] == GROUP and a["value"] is None}
    out = {}
    for cell in stability["cells"]:
        if cell["axis"] in counted:
            row = out.setdefault(cell["method"], {"failures": 0, "trials": 0, "worst_rate": 0.0, "worst_axis": None})
            row["failures"] += cell["failures"]
            row["trials"] += cell["trials"]
            if cell["rate"] > row["worst_rate"]:
                row["worst_rate"], row["worst_axis"] = cell["rate"], cell["axis"]
    for row in out.values():
        row["rate"] = row["failures"] / row["trials"]
        row["low"], row["high"] = st.rate_interval(row["failures"], row["trials"])
    return out


def widest(folder):
    """The results of tools/bench in `folder` that hold the most accelerators, or None."""
    return max(results(folder, "bench"), key=lambda path: len(speeds_of(load(path))[0]), default=None)


def compare(bench, stability):
    """What the second chart shows; no points where the two share nothing."""
    try:
        speeds, cells = speeds_of(bench)
        failures = failures_of(stability)
        points = []
        for config, speed in speeds.items():
            method, name = kind_of(config)
            if method in failures:
                points.append({"config": config, "name": name, "method": method,
                               "mrays_per_s": dict(zip(("mean", "low", "high"), speed)), **failures[method]})
        front = st.pareto([(1 / p["mrays_per_s"]["mean"], p["rate"]) for p in points])
        for i, p in enumerate(points):
            p["pareto"] = i in front
        return {"speed_cpu": bench["cpu"], "failure_cpu": stability["cpu"], "embree": bench["embree"],
                "cells": cells, "points": points}
    except (KeyError, TypeError, AttributeError, ValueError, ZeroDivisionError) as error:
        raise InputError(f"error: not the results of tools/bench and tools/stability ({error!r})") from error
