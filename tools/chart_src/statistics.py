"""Numbers from repeated measurements: slopes, intervals, Pareto front, equal error. Pure numpy."""
import math

import numpy as np

# Two-sided 95 % quantiles of Student's t for 1, 2, 3 ... degrees of freedom (any table).
T95 = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
       2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086]


def t95(freedom):
    """Beyond the table: Cornish-Fisher, within 0.1 %."""
    return T95[freedom - 1] if freedom <= len(T95) else 1.95996 + 2.37228 / freedom + 2.8225 / freedom ** 2


def mean_interval(values):
    """(mean, low, high) at 95 % of independent normal values; low and high None for one value."""
    values = np.asarray(values, float)
    mean = float(values.mean())
    if len(values) < 2:
        return mean, None, None
    half = t95(len(values) - 1) * float(values.std(ddof=1)) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def geometric_interval(values):
    """The same for positive values, on their logarithms."""
    return tuple(None if v is None else math.exp(v) for v in mean_interval(np.log(values)))


def rate_interval(failures, trials):
    """(low, high) at 95 % of a rate (Wilson 1927). No failure: from 0 to the rate of which none would be
    seen with a chance of 5 %, the rule of three."""
    if failures == 0:
        return 0.0, 1 - 0.05 ** (1 / trials)
    z = 1.95996
    middle = (failures + z * z / 2) / (trials + z * z)
    half = z / (trials + z * z) * math.sqrt(failures * (trials - failures) / trials + z * z / 4)
    return middle - half, middle + half


def slope(x, y):
    """Least-squares slope of log y over log x."""
    x, y = np.log(np.asarray(x, float)), np.log(np.asarray(y, float))
    return float(((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum())


def slope_interval(x, curves):
    """(slope, low, high): one fit a seed (a row of `curves`), their mean and t interval."""
    return mean_interval([slope(x, curve) for curve in curves])


def pareto(points):
    """Indices of the (seconds, error) that no other point beats in both, by growing seconds."""
    best, front = math.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            best = points[i][1]
            front.append(i)
    return front


def reference_variance(half_a, half_b):
    """Variance of (a + b) / 2 for independent a and b of equal quality: (a - b)^2 / 4, unbiased."""
    return (half_a - half_b) ** 2 / 4


def time_to_reach(points, error):
    """(seconds, extrapolated) of a curve of (seconds, error): log-log between its points; beyond
    its last point on the line fitted to all of it; None before its first point."""
    points = sorted(points)
    if len(points) < 2 or error > points[0][1]:
        return None
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= error <= e0 and e1 < e0:
            return t0 * (t1 / t0) ** (math.log(error / e0) / math.log(e1 / e0)), False
    fall = slope([t for t, _ in points], [e for _, e in points])
    return (points[-1][0] * (error / points[-1][1]) ** (1 / fall), True) if fall < -0.1 else None


def bend(x, curves, least=0.35):
    """The x after which the error falls more slowly by at least `least` in slope, with 95 %
    confidence over the seeds: (x, slope before, slope after), or None."""
    found = None
    for i in range(2, len(x) - 2):
        before = [slope(x[:i + 1], c[:i + 1]) for c in curves]
        after = [slope(x[i:], c[i:]) for c in curves]
        change, low, _ = mean_interval(np.subtract(after, before))
        if low is not None and low > 0 and change >= least and (not found or change > found[3]):
            found = (x[i], float(np.mean(before)), float(np.mean(after)), change)
    return found[:3] if found else None
