#!/usr/bin/env python3
"""Writes many-lights.xml: COUNT lamps (default 128) on a sunflower spiral, of three kinds and of
powers that differ by a factor of about 100, over a ground with stones.

    make_many_lights.py [COUNT] > many-lights.xml
"""
import colorsys
import math
import random
import sys

GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))

HEAD = """<?xml version="1.0" encoding="utf-8"?>
<!--
    {count} lamps of different kind and power, written by make_many_lights.py: spheres, rectangles that
    shine on the ground and points. Powers differ by a factor of about 100, so a renderer that picks
    its lamps with equal chance is far noisier than one that picks them by power. Metres; y up.
-->
<scene version="3.0.0">
    <default name="res" value="256"/>
    <default name="spp" value="64"/>
    <default name="max_depth" value="5"/>

    <integrator type="path">
        <integer name="max_depth" value="$max_depth"/>
    </integrator>

    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world">
            <lookat origin="0, 5.2, -10.5" target="0, 0.1, -0.9" up="0, 1, 0"/>
        </transform>
        <film type="hdrfilm">
            <integer name="width" value="$res"/>
            <integer name="height" value="$res"/>
            <rfilter type="gaussian"/>
        </film>
        <sampler type="sobol">
            <integer name="sample_count" value="$spp"/>
        </sampler>
    </sensor>

    <emitter type="constant">
        <rgb name="radiance" value="0.012, 0.018, 0.036"/>
    </emitter>

    <bsdf type="diffuse" id="ground">
        <rgb name="reflectance" value="0.42, 0.40, 0.38"/>
    </bsdf>
    <bsdf type="diffuse" id="post">
        <rgb name="reflectance" value="0.12, 0.11, 0.10"/>
    </bsdf>
    <bsdf type="diffuse" id="stone">
        <rgb name="reflectance" value="0.6, 0.58, 0.55"/>
    </bsdf>

    <shape type="disk" id="plaza">
        <transform name="to_world">
            <rotate x="1" angle="-90"/>
            <scale value="40"/>
        </transform>
        <ref id="ground"/>
    </shape>
"""


def numbers(*values):
    return ", ".join(f"{v:.4f}" for v in values)


def box(kind, name, x, y, z, half, turn):
    return f"""    <shape type="cube" id="{name}">
        <transform name="to_world">
            <scale x="{half[0]:.4f}" y="{half[1]:.4f}" z="{half[2]:.4f}"/>
            <rotate y="1" angle="{turn:.1f}"/>
            <translate x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>
        </transform>
        <ref id="{kind}"/>
    </shape>
"""


def sphere_lamp(x, y, z, radius, radiance):
    return f"""    <shape type="sphere">
        <point name="center" x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>
        <float name="radius" value="{radius:.4f}"/>
        <emitter type="area">
            <rgb name="radiance" value="{numbers(*radiance)}"/>
        </emitter>
    </shape>
"""


def rectangle_lamp(x, y, z, half, turn, radiance):
    return f"""    <shape type="rectangle">
        <transform name="to_world">
            <scale x="{half:.4f}" y="{0.6 * half:.4f}"/>
            <rotate x="1" angle="90"/>
            <rotate y="1" angle="{turn:.1f}"/>
            <translate x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>
        </transform>
        <emitter type="area">
            <rgb name="radiance" value="{numbers(*radiance)}"/>
        </emitter>
    </shape>
"""


def point_lamp(x, y, z, intensity):
    return f"""    <emitter type="point">
        <point name="position" x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>
        <rgb name="intensity" value="{numbers(*intensity)}"/>
    </emitter>
"""


def lamp(i, x, z, rng):
    """One lamp with its post; `flux` is in watts a channel, 0.6 to 60."""
    flux = 0.6 * 100 ** rng.random() ** 2
    hue = 0.02 + 0.12 * rng.random() if rng.random() < 0.75 else 0.5 + 0.35 * rng.random()
    colour = [flux * c for c in colorsys.hsv_to_rgb(hue, 0.75, 1.0)]
    height, turn = 0.35 + 0.9 * rng.random(), 360 * rng.random()
    if i % 8 == 7:
        return point_lamp(x, 0.5 * height, z, [c / (4 * math.pi) for c in colour])
    post = box("post", f"post-{i}", x, height / 2, z, (0.02, height / 2, 0.02), turn)
    if i % 8 in (1, 4, 6):
        half = 0.14 + 0.1 * rng.random()
        area = 4 * half * 0.6 * half
        radiance = [c / (math.pi * area) for c in colour]
        return post + rectangle_lamp(x, height + 0.001, z, half, turn, radiance)
    radius = 0.07 + 0.06 * rng.random()
    radiance = [c / (math.pi * 4 * math.pi * radius * radius) for c in colour]
    return post + sphere_lamp(x, height + radius, z, radius, radiance)


def main(arguments):
    count = int(arguments[0]) if arguments else 128
    rng = random.Random(7)
    parts = [HEAD.format(count=count)]
    for i in range(count):
        radius, angle = 0.55 * math.sqrt(i + 0.5), i * GOLDEN_ANGLE
        x, z = radius * math.cos(angle), radius * math.sin(angle)
        parts.append(lamp(i, x, z, rng))
        if i % 4 == 2:
            size = 0.12 + 0.2 * rng.random()
            x, z = x + 0.35, z + 0.2
            parts.append(box("stone", f"stone-{i}", x, 0.6 * size, z, (size, 0.6 * size, 0.7 * size), 360 * rng.random()))
    parts.append("</scene>\n")
    sys.stdout.write("\n".join(parts))


if __name__ == "__main__":
    main(sys.argv[1:])
