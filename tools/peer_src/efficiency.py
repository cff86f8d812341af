"""relMSE and efficiency of pictures of one method. Pictures are arrays of linear RGB."""
import numpy as np

EPSILON = 0.01  # of the squared reference: keeps black pixels from counting without bound


def relative_mse(picture, reference):
    """mean((picture - reference)^2 / (reference^2 + EPSILON)) over pixels and channels."""
    error = picture - reference
    return float(np.mean(error * error / (reference * reference + EPSILON)))


def reference_share(half_a, half_b):
    """What the noise of the mean of two independent halves adds to every relMSE against it."""
    mean, noise = (half_a + half_b) / 2, (half_a - half_b) / 2
    return float(np.mean(noise * noise / (mean * mean + EPSILON)))


def summary(errors, seconds):
    """Of runs with different seeds: median seconds, mean error, 1/(error s) with a 95 % interval
    (normal, of the mean error; the seconds' spread is far below it)."""
    error, time = float(np.mean(errors)), float(np.median(seconds))
    deviation = float(np.std(errors, ddof=1)) if len(errors) > 1 else float("nan")
    half = 1.96 * deviation / np.sqrt(len(errors))
    return {"relmse": error, "seconds": time, "efficiency": 1 / (error * time),
            "efficiency_95": [1 / ((error + half) * time), 1 / (max(error - half, 1e-300) * time)]}
