"""From the runs of a scene to what is said about its methods."""
import numpy as np

from chart_src import statistics as st

# Where a curve bends: the share of the squared error in the worst 0.1 % of the pixels from which on that is put down
# to fireflies. (Where noise is normal they have 1 %; a quarter where a bright light's edge crosses a pixel.)
FIREFLIES = 0.5
MEASURES = {"mse": "mean squared error", "relmse": "relative MSE", "flip": "FLIP"}


def curves_of(runs):
    """{method: [(spp, median seconds, {measure: value of each seed})]}; only levels above the
    reference's noise and with every seed that the first level has."""
    out = {}
    for name in dict.fromkeys(r["method"] for r in runs):
        own = [r for r in runs if r["method"] == name]
        for spp in sorted({r["spp"] for r in own}):
            level = sorted((r for r in own if r["spp"] == spp), key=lambda r: r["seed"])
            curve = out.setdefault(name, [])
            complete = not curve or len(level) == len(curve[0][2]["mse"])
            if complete and all(r["mse"] > 0.5 * r["mse_raw"] for r in level):
                curve.append((spp, float(np.median([r["seconds"] for r in level])),
                              {m: [r[m] for r in level] for m in MEASURES}))
    return {name: curve for name, curve in out.items() if curve}


def fronts(curves):
    """{measure: {(method, spp) that no other beats in time and error}}."""
    out = {}
    for measure in MEASURES:
        points = [(s, float(np.mean(m[measure])), name, spp) for name, c in curves.items() for spp, s, m in c]
        out[measure] = {points[i][2:] for i in st.pareto([p[:2] for p in points])}
    return out


def summary(runs):
    """A row a method: points with the mean of each measure, the rest from the mean squared error."""
    curves = curves_of(runs)
    front = fronts(curves)
    out = []
    for name, curve in curves.items():
        spp, by_seed = [c[0] for c in curve], np.array([c[2]["mse"] for c in curve]).T
        row = {"method": name, "points": [{"spp": n, "seconds": s, **{m: float(np.mean(v)) for m, v in by.items()},
                                           "front": [m for m in MEASURES if (name, n) in front[m]]}
                                          for n, s, by in curve],
               "efficiency": st.geometric_interval([1 / (m * curve[-1][1]) for m in by_seed[:, -1]]),
               "slope": None, "bend": None, "factor": None, "outlier_share": outlier_share(runs, name, curve[-1][0])}
        if len(spp) > 1:
            row["slope"] = st.slope_interval(spp, by_seed)
            row["bend"] = st.bend(spp, by_seed)
        if name != "default" and "default" in curves:
            row["factor"] = factor(curves["default"], curve)
        out.append(row)
    return out


def outlier_share(runs, method, spp):
    """The median over the seeds."""
    return float(np.median([r["outlier_share"] for r in runs if (r["method"], r["spp"]) == (method, spp)]))


def cause(row):
    """Why a curve bends: what more samples should have averaged out sits in a few pixels, or it does not."""
    return "fireflies" if row["outlier_share"] >= FIREFLIES else "bias"


def factor(default, other):
    """How many times longer `other` takes for the least error that both can be asked for: its own
    last error if the default's curve holds it, else the default's first (extrapolated). The geometric
    mean over the seeds, each with its own two curves; from the mean errors where a seed has no answer."""
    def points(curve, pick):
        return [(s, pick(by["mse"])) for _, s, by in curve]
    error = float(min(points(other, np.mean)[-1][1], points(default, np.mean)[0][1]))

    def times(pick):
        a, b = (st.time_to_reach(points(curve, pick), error) for curve in (default, other))
        return (b[0] / a[0], a[1] or b[1]) if a and b else None
    whole = times(lambda mse: float(np.mean(mse)))
    if not whole:
        return None
    seeds = range(min(len(curve[0][2]["mse"]) for curve in (default, other)))
    each = [times(lambda mse, i=i: mse[i]) for i in seeds]
    mean, low, high = st.geometric_interval([t[0] for t in each]) if all(each) else (whole[0], None, None)
    return {"error": error, "times": mean, "low": low, "high": high, "extrapolated": whole[1]}


def text(result):
    def span(v):
        return f"{v[0]:10.4g}" + (f" ({v[1]:.4g} to {v[2]:.4g})" if v[1] is not None else "")
    lines = [f"{result['name']}: reference {result['reference']['spp']} spp, MSE {result['reference']['mse']:.2g}"]
    for r in result["summary"]:
        line = f"  {r['method']:<32} to {r['points'][-1]['spp']:>4} spp"
        line += "  slope" + span(r["slope"]) if r["slope"] else ""
        if r["factor"]:
            far = " (extrapolated)" if r["factor"]["extrapolated"] else ""
            line += f"  {r['factor']['times']:.3g} x default's time{far}"
        lines.append(line + (f"  bends at {r['bend'][0]} spp ({cause(r)})" if r["bend"] else ""))
    return "\n".join(lines)
