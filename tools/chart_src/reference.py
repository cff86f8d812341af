"""The converged picture of a scene: two independent halves, kept in a cache and refined."""
import hashlib
import os
import re
import time

import numpy as np

from chart_src.flip_hdr import HdrFlip
from chart_src.measure import version
from chart_src.methods import Method
from chart_src.statistics import reference_variance

FIRST_SEED = 1_000_000  # far from the seeds of the methods


class Reference:
    def __init__(self, half_a, half_b, spp, seconds):
        self.halves, self.spp, self.seconds = (half_a, half_b), spp, seconds
        self.mean = (half_a + half_b) / 2
        self.variance = reference_variance(half_a, half_b)
        self.flip = HdrFlip(self.mean)
        # Of one half: its noise is that of the mean times the root of two.
        self.flip_noise = self.flip.mean(half_a)


def key_of(scene, renderer):
    """Of the scene's text, the files that it names, the size and the renderer's version."""
    with open(scene, "rb") as file:
        text = file.read()
    digest = hashlib.sha256(text)
    for name in re.findall(rb'value="([^"$]+\.\w+)"', text):
        path = os.path.join(os.path.dirname(scene), name.decode(errors="replace"))
        if os.path.isfile(path):
            with open(path, "rb") as file:
                digest.update(file.read())
    digest.update(f"{renderer.width} {version(renderer.program)}".encode())
    return digest.hexdigest()[:24]


def make_reference(scene, renderer, cache, budget_s):
    """From the cache if it had at least half of `budget_s` seconds; else pairs of doubling spp that
    fit, from 1 spp on, so that a slow scene stays within them too."""
    path = os.path.join(cache, key_of(scene, renderer) + ".npz")
    halves, spp, spent, level = [0.0, 0.0], 0, 0.0, 1
    if os.path.exists(path):
        with np.load(path) as kept:
            halves, spp = [kept["a"], kept["b"]], int(kept["spp"])
            spent, level = float(kept["seconds"]), int(kept["level"])
        if spent >= budget_s / 2:
            return Reference(*halves, 2 * spp, spent)
    end, took = time.monotonic() + budget_s, 0.0
    while spp == 0 or time.monotonic() + 2.1 * took < end:
        begun = time.monotonic()
        for i in range(2):
            picture, _ = renderer.render(scene, Method("default", {}), level, FIRST_SEED + 2 * level + i)
            halves[i] = (halves[i] * spp + picture * level) / (spp + level)
        took = time.monotonic() - begun
        spp, spent, level = spp + level, spent + took, 2 * level
    os.makedirs(cache, exist_ok=True)
    part = f"{path}.{os.getpid()}.npz"
    np.savez(part, a=halves[0], b=halves[1], spp=spp, seconds=spent, level=level)
    os.replace(part, path)
    return Reference(*halves, 2 * spp, spent)
