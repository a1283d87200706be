#!/usr/bin/env python3
"""Writes a torus knot with vertex normals as PLY to standard output: make_knot.py [STEPS SIDES] > knot.ply

The knot goes 2 times round the axis z and 3 times round the tube of a torus. STEPS rings of SIDES vertices make
2 * STEPS * SIDES triangles: 64 rings of 8, the default, make 1,024. It fits the unit ball.
"""

import math
import sys


def point(t):
    """On the knot's line, for t from 0 to 1."""
    around, through = 2 * math.pi * 2 * t, 2 * math.pi * 3 * t
    r = 0.58 + 0.26 * math.cos(through)
    return [r * math.cos(around), r * math.sin(around), 0.26 * math.sin(through)]


def unit(v):
    length = math.hypot(*v)
    return [x / length for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def ring(t, sides, radius):
    """The vertices and normals of the tube about one point of the line."""
    centre, h = point(t), 1e-4
    along = unit([b - a for a, b in zip(point(t - h), point(t + h))])
    # The centre of the torus's tube never lies on the line's tangent, so this frame has no twist to it.
    around = 2 * math.pi * 2 * t
    inward = [c - o for c, o in zip([0.58 * math.cos(around), 0.58 * math.sin(around), 0], centre)]
    side = unit(cross(along, inward))
    up = cross(side, along)
    for k in range(sides):
        a = 2 * math.pi * k / sides
        normal = [math.cos(a) * s + math.sin(a) * u for s, u in zip(side, up)]
        yield [c + radius * n for c, n in zip(centre, normal)] + normal


def main():
    steps, sides = (int(a) for a in sys.argv[1:3]) if len(sys.argv) > 2 else (64, 8)
    vertices = [v for i in range(steps) for v in ring(i / steps, sides, 0.13)]
    print(f"ply\nformat ascii 1.0\ncomment torus knot by make_knot.py {steps} {sides}\nelement vertex {len(vertices)}")
    for name in ("x", "y", "z", "nx", "ny", "nz"):
        print("property float", name)
    print(f"element face {2 * steps * sides}\nproperty list uchar int vertex_indices\nend_header")
    for v in vertices:
        print(*(f"{x:.5f}" for x in v))
    for i in range(steps):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (a + sides) % len(vertices), (b + sides) % len(vertices)
            print(3, a, b, d)
            print(3, a, d, c)


if __name__ == "__main__":
    main()
