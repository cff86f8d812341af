"""Renders with one method and measures the picture against the reference."""
import json
import os
import subprocess
import time

import numpy as np


class RenderError(Exception):
    """The renderer refused: its own line, its exit code."""

    def __init__(self, text, code):
        super().__init__(text)
        self.code = code


def read_pfm(path):
    """Float array (height, width, 3), the top row first."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"PF":
            raise ValueError(f"{path}: not a colour PFM")
        width, height = map(int, file.readline().split())
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        data = np.frombuffer(file.read(), order, width * height * 3)
    return data.reshape(height, width, 3)[::-1].astype(float)


def version(program):
    return subprocess.run([program, "--version"], capture_output=True, text=True, check=False).stdout.strip()


class Renderer:
    """The program, with what is the same for all runs; scratch files go to `folder`."""

    def __init__(self, program, folder, threads, width):
        self.program, self.folder, self.threads, self.width = program, folder, threads, width

    def size(self, scene):
        with open(scene, encoding="utf-8", errors="replace") as file:
            return ["-D", f"res={self.width}"] if '<default name="res"' in file.read() else []

    def render(self, scene, method, spp, seed):
        """(picture, record of times in seconds, counts and bytes)."""
        image, stats = (os.path.join(self.folder, name) for name in ("image.pfm", "stats.json"))
        command = [self.program, "-q", "--threads", str(self.threads), "--spp", str(spp), "--seed",
                   str(seed), "-o", image, "--stats", stats, *self.size(scene), *method.arguments(), scene]
        begun = time.monotonic()
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                   text=True, start_new_session=True)
        try:
            errors = process.stderr.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            elapsed_s = time.monotonic() - begun
        except KeyboardInterrupt:
            process.kill()
            process.wait()
            raise
        if process.returncode != 0:
            raise RenderError(errors.strip(), process.returncode if process.returncode > 0 else 70)
        with open(stats, encoding="utf-8") as file:
            told = json.load(file)
        # Starting, loading and building are not the method's: of the rendering's wall time the share that
        # the whole process had of its own.
        cpu_s = told["render_s"] * (usage.ru_utime + usage.ru_stime) / elapsed_s
        record = {"method": method.name, "spp": spp, "seed": seed, "wall_s": told["render_s"],
                  "cpu_s": cpu_s, "samples": told["samples"],
                  "rays": told["rays"]["total"], "memory_bytes": told["peak_bytes"]}
        return read_pfm(image), record


def errors_of(picture, reference):
    """MSE and relMSE = mean(d^2 / (ref^2 + 0.01)), both less the reference's own variance; FLIP, which
    nothing can be taken off: the reference's `flip_noise` says where it stops to tell."""
    square = (picture - reference.mean) ** 2
    weight = 1 / (reference.mean ** 2 + 0.01)
    return {"mse": float((square - reference.variance).mean()), "mse_raw": float(square.mean()),
            "relmse": float(((square - reference.variance) * weight).mean()),
            "outlier_share": outlier_share(square), "flip": reference.flip.mean(picture)}


def outlier_share(square):
    """Share of the squared error that lies in the worst 0.1 % of the pixels."""
    pixels = np.sort(square.sum(axis=2).ravel())
    total = pixels.sum()
    return float(pixels[-max(1, len(pixels) // 1000):].sum() / total) if total > 0 else 0.0

