#!/usr/bin/env python3
"""Writes meshes/trefoil.obj, the lamp of mesh-light.xml: a tube around a trefoil knot, 768 triangles.

The knot is (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t); the tube's frame is carried along it
without twist and closed by spreading the remaining angle over the whole length.
"""
import math
import sys

ALONG, AROUND, RADIUS = 64, 6, 0.42


def knot(t):
    return (math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -math.sin(3 * t))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def tangent(t):
    h = 1e-5
    return unit(tuple(b - a for a, b in zip(knot(t - h), knot(t + h))))


def carried(normal, along):
    """`normal` made perpendicular to the direction `along` again."""
    return unit(tuple(n - dot(normal, along) * a for n, a in zip(normal, along)))


def frames():
    steps = [2 * math.pi * i / ALONG for i in range(ALONG)]
    normals = [carried((0.0, 0.0, 1.0), tangent(0.0))]
    for t in steps[1:]:
        normals.append(carried(normals[-1], tangent(t)))
    last = carried(normals[-1], tangent(0.0))
    twist = math.atan2(dot(cross(last, normals[0]), tangent(0.0)), dot(last, normals[0]))
    return [(t, normal, twist * i / ALONG) for i, (t, normal) in enumerate(zip(steps, normals))]


def write(file):
    print("# Trefoil tube, made by make_trefoil.py; front outside.", file=file)
    for t, normal, turn in frames():
        centre, side = knot(t), cross(tangent(t), normal)
        for k in range(AROUND):
            angle = 2 * math.pi * k / AROUND + turn
            c, s = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
            print("v %.5f %.5f %.5f" % tuple(p + c * n + s * b for p, n, b in zip(centre, normal, side)), file=file)
    for i in range(ALONG):
        for k in range(AROUND):
            a, b = i * AROUND + k + 1, i * AROUND + (k + 1) % AROUND + 1
            c, d = (i + 1) % ALONG * AROUND + (k + 1) % AROUND + 1, (i + 1) % ALONG * AROUND + k + 1
            print(f"f {a} {b} {c}\nf {a} {c} {d}", file=file)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_trefoil.py OUTPUT.obj")
    with open(sys.argv[1], "w", encoding="ascii") as output:
        write(output)
