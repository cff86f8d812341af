"""From the runs of a scene to what is said about its methods."""
import numpy as np

from chart_src import statistics as st


def curves_of(runs):
    """{method: [(spp, median seconds, mse of each seed)]}; only levels above the reference's noise
    and with every seed that the first level has."""
    out = {}
    for name in dict.fromkeys(r["method"] for r in runs):
        own = [r for r in runs if r["method"] == name]
        for spp in sorted({r["spp"] for r in own}):
            level = sorted((r for r in own if r["spp"] == spp), key=lambda r: r["seed"])
            mse = [r["mse"] for r in level]
            curve = out.setdefault(name, [])
            if all(r["mse"] > 0.5 * r["mse_raw"] for r in level) and (not curve or len(mse) == len(curve[0][2])):
                curve.append((spp, float(np.median([r["seconds"] for r in level])), mse))
    return {name: curve for name, curve in out.items() if curve}


def summary(runs):
    curves = curves_of(runs)
    points = [(s, float(np.mean(m)), name, spp) for name, c in curves.items() for spp, s, m in c]
    front = {points[i][2:] for i in st.pareto([p[:2] for p in points])}
    out = []
    for name, curve in curves.items():
        spp, by_seed = [c[0] for c in curve], np.array([c[2] for c in curve]).T
        row = {"method": name, "points": [{"spp": c[0], "seconds": c[1], "mse": float(np.mean(c[2])),
                                           "pareto": (name, c[0]) in front} for c in curve],
               "efficiency": st.geometric_interval([1 / (m * curve[-1][1]) for m in curve[-1][2]]),
               "slope": None, "bend": None, "factor": None}
        if len(spp) > 1:
            row["slope"] = st.slope_interval(spp, by_seed)
            row["bend"] = st.bend(spp, by_seed)
        own = [(p["seconds"], p["mse"]) for p in row["points"]]
        if name != "default" and "default" in curves:
            row["factor"] = factor([(s, float(np.mean(m))) for _, s, m in curves["default"]], own)
        out.append(row)
    return out


def factor(default, other):
    """How many times longer `other` takes for the least error that both can be asked for: its own
    last error if the default's curve holds it, else the default's first (extrapolated)."""
    error = min(other[-1][1], default[0][1])
    a, b = st.time_to_reach(default, error), st.time_to_reach(other, error)
    return {"error": error, "times": b[0] / a[0], "extrapolated": a[1] or b[1]} if a and b else None


def text(result):
    def span(v):
        return f"{v[0]:10.4g}" + (f" ({v[1]:.4g} to {v[2]:.4g})" if v[1] is not None else "")
    lines = [f"{result['name']}: reference {result['reference']['spp']} spp, MSE {result['reference']['mse']:.2g}"]
    for r in result["summary"]:
        line = f"  {r['method']:<32} to {r['points'][-1]['spp']:>4} spp"
        line += "  slope" + span(r["slope"]) if r["slope"] else ""
        if r["factor"]:
            line += f"  {r['factor']['times']:.3g} x default's time" + (" (extrapolated)" if r["factor"]["extrapolated"] else "")
        lines.append(line + (f"  bends at {r['bend'][0]} spp" if r["bend"] else ""))
    return "\n".join(lines)
