"""NFF scenes as Tachyon scenes of the same picture: used by `peers` to time Tachyon beside RayEngine.

Tachyon's own NFF reader shows another picture: mirrored, at more than twice the angle, its lights fading. Tachyon has no
cones, so cylinders of the mean radius stand in for them, and what transmits is seen through without refraction.
"""

import itertools
import math

import nff


def mirrored(values):
    """Tachyon's coordinates are left-handed."""
    x, y, z = values
    return f"{-x!r} {y!r} {z!r}"


def area_vector(points):
    """Twice a polygon's area, along its normal (Newell)."""
    sums = [0.0, 0.0, 0.0]
    for p, q in zip(points, points[1:] + points[:1]):
        for axis in range(3):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            sums[axis] += (p[a] - q[a]) * (p[b] + q[b])
    return sums


def is_ear(corners, i, plane):
    """Whether the corner is convex and no other corner lies in its triangle. `plane` turns 3D points counter-clockwise."""
    a, b, c = (plane(corners[k % len(corners)]) for k in (i - 1, i, i + 1))

    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    if side(a, b, c) <= 0:
        return False
    others = (plane(p) for p in corners)
    return not any(p not in (a, b, c) and side(a, b, p) >= 0 and side(b, c, p) >= 0 and side(c, a, p) >= 0 for p in others)


def triangles(corners):
    """A flat polygon, concave ones too, by cutting ears."""
    normal = area_vector(corners)
    axis = max(range(3), key=lambda k: abs(normal[k]))
    a, b = ((axis + 1) % 3, (axis + 2) % 3) if normal[axis] > 0 else ((axis + 2) % 3, (axis + 1) % 3)
    rest = list(corners)
    while len(rest) > 3:
        ear = next((i for i in range(len(rest)) if is_ear(rest, i, lambda p: (p[a], p[b]))), 0)
        yield rest[ear - 1], rest[ear], rest[(ear + 1) % len(rest)]
        del rest[ear]
    yield tuple(rest)


class Converter(nff.Reader):
    def __init__(self, size):
        self.size = size
        self.textures = {}
        self.texture = None
        self.head, self.lights, self.objects = [], [], []

    def convert(self, text):
        self.read(text)
        return "\n".join(["BEGIN_SCENE", f"RESOLUTION {self.size} {self.size}"] + self.head + self.light_sources() +
                         self.objects + ["END_SCENE"]) + "\n"

    def view(self, eye, at, up, angle):
        direction = [a - e for a, e in zip(at, eye)]
        self.reach = math.hypot(*direction)
        self.head.append(f"CAMERA ZOOM {0.5 / math.tan(math.radians(angle / 2))!r} ASPECTRATIO 1.0 ANTIALIASING 0 RAYDEPTH 5 "
                         f"CENTER {mirrored(eye)} VIEWDIR {mirrored(direction)} UPDIR {mirrored(up)} END_CAMERA")

    def background(self, color):
        self.head.append("BACKGROUND " + " ".join(map(repr, color)))

    def light(self, position, color):
        self.lights.append((position, color))

    def light_sources(self):
        """Tachyon draws lights as balls: too small ones to be seen."""
        each = [1 / len(self.lights) ** 0.5] * 3 if self.lights else None
        return [f"LIGHT CENTER {mirrored(at)} RAD {1e-6 * self.reach!r} COLOR {' '.join(map(repr, color or each))}"
                for at, color in self.lights]

    def fill(self, *key):
        self.texture = self.textures.get(key)
        if self.texture:
            return
        self.texture = self.textures[key] = f"T{len(self.textures)}"
        r, g, b, kd, ks, shine, transmit, _ = key
        self.objects.append(f"TEXDEF {self.texture} AMBIENT 0.0 DIFFUSE {kd!r} SPECULAR {ks!r} OPACITY {1 - transmit!r} "
                            f"PHONG PLASTIC {ks!r} PHONG_SIZE {shine!r} COLOR {r!r} {g!r} {b!r} TEXFUNC 0")

    def sphere(self, center, radius):
        self.objects.append(f"SPHERE CENTER {mirrored(center)} RAD {radius!r} {self.texture}")

    def cone(self, base, base_radius, apex, apex_radius):
        self.objects.append(f"FCYLINDER BASE {mirrored(base)} APEX {mirrored(apex)} RAD {(base_radius + apex_radius) / 2!r} "
                            f"{self.texture}")

    def polygon(self, corners):
        for v in triangles(corners):
            self.objects.append("TRI " + " ".join(f"V{k} {mirrored(v[k])}" for k in range(3)) + f" {self.texture}")

    def patch(self, corners):
        for b, c in itertools.pairwise(corners[1:]):
            three = (corners[0], b, c)
            places = " ".join(f"V{k} {mirrored(three[k][0])}" for k in range(3))
            normals = " ".join(f"N{k} {mirrored(three[k][1])}" for k in range(3))
            self.objects.append(f"STRI {places} {normals} {self.texture}")


def convert(text, size):
    """Tachyon scene text for an NFF file's text, square, `size` pixels across."""
    return Converter(size).convert(text)
