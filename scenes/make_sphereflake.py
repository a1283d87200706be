#!/usr/bin/env python3
"""Writes the scene of a sphereflake to standard output: make_sphereflake.py [DEPTH] > sphereflake.json

A sphereflake of depth 0 is a sphere; one of depth n is a sphere with nine flakes of depth n-1, a third as large, on its
surface: six round its equator and three above. So it has (9^(n+1) - 1) / 8 spheres: 7,381 at depth 4, the default.
Flakes up to depth 2 are spheres one by one; larger ones are groups that place the next smaller nine times, so that the
file grows with the depth alone. The figure is from Eric Haines, "A Proposal for Standard Graphics Environments" (1987).
"""

import json
import math
import sys

SHADES = [[1.0, 0.62, 0.12], [0.95, 0.42, 0.14], [0.78, 0.16, 0.18], [0.46, 0.12, 0.38], [0.20, 0.20, 0.62]]
TUFT_DEPTH = 2  # the largest flake that is written sphere by sphere


def directions():
    """Azimuth and angle from the axis, in degrees, of the nine spheres on one."""
    return [(60 * i, 90) for i in range(6)] + [(120 * i + 30, 35.264389682754654) for i in range(3)]


def child_matrix(azimuth, angle):
    """The frame of a child in its parent's, 4x4: a third as large, touching, its axis outward."""
    a, b = math.radians(azimuth), math.radians(angle)
    u = (math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), -math.sin(b))
    v = (-math.sin(a), math.cos(a), 0)
    w = (math.cos(a) * math.sin(b), math.sin(a) * math.sin(b), math.cos(b))
    return [[u[i] / 3, v[i] / 3, w[i] / 3, 4 / 3 * w[i]] for i in range(3)] + [[0, 0, 0, 1]]


CHILDREN = [child_matrix(*d) for d in directions()]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def spheres(level, depth, matrix=((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))):
    """A flake sphere by sphere; a sphere needs no more than its radius and its centre."""
    radius = math.hypot(*(row[0] for row in matrix[:3]))
    centre = [round(row[3], 12) for row in matrix[:3]]
    yield {"type": "sphere", "material": f"level {level}", "transform": [{"scale": round(radius, 12)}, {"translate": centre}]}
    if depth > 0:
        for child in CHILDREN:
            yield from spheres(level + 1, depth - 1, product(matrix, child))


def placed(group):
    """A sphere's nine children, each an instance of a group."""
    for azimuth, angle in directions():
        steps = [{"scale": round(1 / 3, 12)}]
        if angle == 90:  # steps that a reader can follow
            steps += [{"translate": [0, 0, round(4 / 3, 12)]}, {"rotate": {"axis": [0, 1, 0], "degrees": 90}}]
        else:
            steps += [{"translate": [0, 0, round(4 / 3, 12)]}, {"rotate": {"axis": [0, 1, 0], "degrees": angle}}]
        yield {"type": "instance", "group": group, "transform": steps + [{"rotate": {"axis": [0, 0, 1], "degrees": azimuth}}]}


def flake(depth):
    """The groups of a flake and the objects of the largest."""
    objects, groups = list(spheres(max(depth - TUFT_DEPTH, 0), min(depth, TUFT_DEPTH))), {}
    for level in range(depth - TUFT_DEPTH - 1, -1, -1):
        name = f"flake {depth - level - 1}"
        groups[name] = {"objects": objects}
        objects = [{"type": "sphere", "material": f"level {level}"}, *placed(name)]
    return groups, objects


def lines(value, indent=""):
    """JSON with one object of the scene a line."""
    return f",\n{indent}".join(json.dumps(v) for v in value)


def main():
    depth = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    if depth < 0:
        sys.exit("the depth of a sphereflake is 0 or more")
    groups, objects = flake(depth)
    materials = {f"level {i}": {"color": SHADES[i % len(SHADES)], "diffuse": 0.7, "specular": 0.35, "shininess": 60,
                                "ambient": 0.06, "reflect": 0.22 if i < 2 else 0.1} for i in range(depth + 1)}
    materials["floor"] = {"color": [0.50, 0.50, 0.52], "diffuse": 0.7, "ambient": 0.04, "reflect": 0.2}
    objects.append({"type": "plane", "material": "floor", "transform": [{"translate": [0, 0, -1]}]})
    lights = [{"position": [6, -3, 7], "color": [1.0, 0.94, 0.82]}, {"position": [-5, -7, 4], "color": [0.36, 0.40, 0.50]},
              {"position": [-4, 6, 9], "color": [0.24, 0.24, 0.30]}]
    print("{")
    print(' "camera": {"from": [3.4, -5.2, 1.7], "at": [0, 0, 0.22], "fov": 38, "size": [512, 512]},')
    print(' "background": [0.16, 0.27, 0.46],')
    print(' "lights": [\n  ' + lines(lights, "  ") + "],")
    print(' "materials": {\n  ' + ",\n  ".join(f'"{k}": {json.dumps(v)}' for k, v in materials.items()) + "},")
    for separator, (name, group) in zip(["", *[",\n"] * len(groups)], groups.items()):
        print((separator or ' "groups": {\n') + f'  "{name}": {{"objects": [\n   ' + lines(group["objects"], "   ") + "]}", end="")
    if groups:
        print("},")
    print(' "objects": [\n  ' + lines(objects, "  ") + "]}")


if __name__ == "__main__":
    main()
