#!/usr/bin/env python3
"""Writes scenes with more triangles than they need into a folder: make_tessellations.py FOLDER

far.json     a bumpy ball of a million triangles that is 100 pixels wide
flake.json   a sphereflake of 7,381 spheres as one mesh, 512 triangles each (flake-exact.json: the spheres themselves)
screws.json  343 times the same stud of 7,168 triangles, each written as a mesh of its own

Meshes are binary .ply files beside them. See docs/plan.md for what a plan makes of these.
"""

import json
import math
import pathlib
import struct
import sys
from array import array

from make_sphereflake import spheres

LIGHTS = [{"type": "point", "position": [5, -8, 9]}, {"type": "point", "position": [-6, -4, 3], "color": [0.4, 0.4, 0.5]}]
PLASTIC = {"color": [0.85, 0.55, 0.2], "diffuse": 0.8, "specular": 0.3, "shininess": 40}


def write_ply(file, positions, triangles):
    """positions: floats, three a vertex; triangles: index triples."""
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions) // 3}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    pack = struct.Struct("<Biii").pack
    with open(file, "wb") as out:
        out.write(header.encode())
        out.write(array("f", positions).tobytes())
        out.write(b"".join(pack(3, *t) for t in triangles))


def write_scene(file, camera, objects):
    scene = {"camera": camera, "background": [0.1, 0.12, 0.16], "lights": LIGHTS, "materials": {"plastic": PLASTIC},
             "objects": objects}
    pathlib.Path(file).write_text(json.dumps(scene))


def round_grid(point, around, along):
    """A surface over a grid that closes round: point(u, v) with u in [0, 1) and v in [0, 1]."""
    positions, triangles = [], []
    for i in range(around):
        for j in range(along):
            positions.extend(point(i / around, j / (along - 1)))
    for i in range(around):
        here, beside = i * along, (i + 1) % around * along
        for j in range(along - 1):
            triangles.append((here + j, here + j + 1, beside + j))
            triangles.append((beside + j, here + j + 1, beside + j + 1))
    return positions, triangles


def bumpy(u, v):
    a, b = 2 * math.pi * u, math.pi * (0.0005 + 0.999 * v)
    x, y, z = math.sin(b) * math.cos(a), math.sin(b) * math.sin(a), math.cos(b)
    r = 1 + 0.05 * math.sin(9 * x) * math.sin(8 * y + 1) * math.sin(7 * z) + 0.002 * math.sin(60 * x) * math.sin(55 * y)
    return r * x, r * y, r * z


def stud(u, v):
    """A thread that runs out into a point."""
    height = 2 * v
    r = (0.3 + 0.06 * abs(math.sin(math.pi * (8 * v + u)))) * min(1, 6 * (1 - v) + 1e-3)
    return r * math.cos(2 * math.pi * u), r * math.sin(2 * math.pi * u), height


def octahedral_sphere(subdivisions):
    positions = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                p = [positions[a][k] + positions[b][k] for k in range(3)]
                length = math.sqrt(sum(x * x for x in p))
                middles[key] = len(positions)
                positions.append(tuple(x / length for x in p))
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return positions, triangles


def make_far(folder):
    write_ply(folder / "far.ply", *round_grid(bumpy, 708, 708))
    write_scene(folder / "far.json", {"from": [0, -12.4, 0], "at": [0, 0, 0], "fov": 45},
                [{"type": "mesh", "file": "far.ply", "material": "plastic"}])


def make_flake(folder):
    camera = {"from": [1.8, -4.2, 2.4], "at": [0, 0, 0.1], "fov": 42}
    flake = list(spheres(0, 4))
    for sphere in flake:
        sphere["material"] = "plastic"
    write_scene(folder / "flake-exact.json", camera, flake)
    unit, faces = octahedral_sphere(3)
    positions, triangles = [], []
    for i, sphere in enumerate(flake):
        scale, centre = sphere["transform"][0]["scale"], sphere["transform"][1]["translate"]
        positions.extend(scale * p[k] + centre[k] for p in unit for k in range(3))
        base = i * len(unit)
        triangles.extend((a + base, b + base, c + base) for a, b, c in faces)
    write_ply(folder / "flake.ply", positions, triangles)
    write_scene(folder / "flake.json", camera, [{"type": "mesh", "file": "flake.ply", "material": "plastic"}])


def make_screws(folder):
    write_ply(folder / "screw.ply", *round_grid(stud, 32, 113))
    places = [(2 * i - 6, 2 * j - 6, 3 * k) for i in range(7) for j in range(7) for k in range(7)]
    write_scene(folder / "screws.json", {"from": [20, -34, 24], "at": [0, 0, 9], "fov": 36},
                [{"type": "mesh", "file": "screw.ply", "material": "plastic", "transform": [{"translate": p}]}
                 for p in places])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    make_far(target)
    make_flake(target)
    make_screws(target)
