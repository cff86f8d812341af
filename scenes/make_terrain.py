#!/usr/bin/env python3
"""Writes the mesh of terrain.xml: an island of 320,000 triangles as binary PLY (6 MB).

A height field over [-1, 1]^2 of 401 x 401 vertices: ridged and plain value noise in seven octaves,
sunk towards the rim so that the sea surrounds it. The same bytes on every run and machine: the
lattice values come from an integer hash, and all arithmetic is IEEE double, rounded once to float.
"""
import array
import math
import sys

CELLS = 400
OCTAVES = 7


def lattice(x, y, octave):
    """A value in [0, 1) for a lattice point: 32-bit integer hash (Wellons' lowbias32)."""
    h = (x * 0x9E3779B1 + y * 0x85EBCA77 + octave * 0xC2B2AE3D) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 0x7FEB352D) & 0xFFFFFFFF
    h = ((h ^ (h >> 15)) * 0x846CA68B) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 4294967296.0


def octave_rows(octave, frequency):
    """Value noise over the grid, a row at a time; quintic blend between lattice points."""
    def blend(t):
        return t * t * t * (t * (t * 6 - 15) + 10)

    columns = []
    for i in range(CELLS + 1):
        x = frequency * i / CELLS
        columns.append((int(x), blend(x - int(x))))
    for j in range(CELLS + 1):
        y = frequency * j / CELLS
        y0, v = int(y), blend(y - int(y))
        line = []
        for x in range(int(frequency) + 2):
            a, b = lattice(x, y0, octave), lattice(x, y0 + 1, octave)
            line.append(a + (b - a) * v)
        yield [line[x0] + (line[x0 + 1] - line[x0]) * u for x0, u in columns]


def heights():
    """Height in units of the field's half width, by rows of rising z."""
    field = [[0.0] * (CELLS + 1) for _ in range(CELLS + 1)]
    amplitude, frequency = 1.0, 3.7
    for octave in range(OCTAVES):
        for row, noise in zip(field, octave_rows(octave, frequency)):
            for i, value in enumerate(noise):
                # The first four octaves make ridges, the rest roughness.
                ridge = 1 - abs(2 * value - 1) if octave < 4 else value
                row[i] += amplitude * (ridge * ridge if octave < 4 else ridge - 0.5)
        amplitude, frequency = amplitude * 0.46, frequency * 2.03
    for j, row in enumerate(field):
        z = 2 * j / CELLS - 1
        for i, value in enumerate(row):
            x = 2 * i / CELLS - 1
            away = min(1.0, math.sqrt(x * x + z * z))
            shore, value = 1 - away * away, max(0.0, value)
            row[i] = 0.3 * (value * shore) * math.sqrt(value * shore) - 0.05 * away
    return field


def write(path):
    side = CELLS + 1
    vertices = array.array("f")
    for j, row in enumerate(heights()):
        for i, y in enumerate(row):
            vertices.extend((2 * i / CELLS - 1, y, 2 * j / CELLS - 1))
    if sys.byteorder == "big":
        vertices.byteswap()
    faces = bytearray()
    for j in range(CELLS):
        for i in range(CELLS):
            a = j * side + i  # the corners in the order that turns the front up
            for corners in ((a, a + side, a + side + 1), (a, a + side + 1, a + 1)):
                faces += b"\x03"
                for corner in corners:
                    faces += corner.to_bytes(4, "little")
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment made by make_terrain.py\n"
        f"element vertex {side * side}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {2 * CELLS * CELLS}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(path, "wb") as file:
        file.write(header.encode("ascii"))
        file.write(vertices.tobytes())
        file.write(faces)
    print(f"{path}: {2 * CELLS * CELLS} triangles")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_terrain.py OUTPUT.ply")
    write(sys.argv[1])
