"""NFF scenes as POV-Ray 3.7 scenes of the same picture: used by `peers` to time POV-Ray beside RayEngine."""

import itertools

import nff

# POV-Ray drops hits nearer than 1e-4, which small scenes need: a power of two enlarges them without rounding.
SCALE = 1024.0


def vector(values):
    return "<" + ",".join(repr(v) for v in values) + ">"


def point(values):
    return vector(SCALE * x for x in values)


class Converter(nff.Reader):
    def __init__(self):
        self.textures = {}
        self.texture = None
        self.head = ["#version 3.7;", "global_settings { assumed_gamma 1 max_trace_level 5 adc_bailout 1/2048 ambient_light rgb 0 }"]
        self.lights = []
        self.objects = []  # (texture, "mesh" for what a mesh can hold, text)

    def convert(self, text):
        self.read(text)
        return "\n".join(self.head + self.light_sources() + self.declarations() + self.bodies()) + "\n"

    def view(self, eye, at, up, angle):
        # `right -x` makes the coordinates right-handed, as NFF's are.
        self.head.append(f"camera {{ perspective location {point(eye)} sky {vector(up)} up y right -x "
                         f"angle {angle!r} look_at {point(at)} }}")

    def background(self, color):
        self.head.append(f"background {{ rgb {vector(color)} }}")

    def light(self, position, color):
        self.lights.append((point(position), color))

    def light_sources(self):
        each = [1 / len(self.lights) ** 0.5] * 3 if self.lights else None
        return [f"light_source {{ {at} rgb {vector(color or each)} }}" for at, color in self.lights]

    def fill(self, *key):
        self.texture = self.textures.setdefault(key, f"T{len(self.textures)}")

    def declarations(self):
        lines = []
        for (r, g, b, kd, ks, shine, transmit, ior), name in self.textures.items():
            lines.append(f"#declare {name} = texture {{ pigment {{ rgbf {vector((r, g, b, transmit))} }} finish {{ ambient 0 "
                         f"diffuse {kd!r} phong {ks!r} phong_size {shine!r} reflection {ks!r} }} }}")
            lines.append(f"#declare I{name} = interior {{ ior {ior if transmit > 0 and ior > 0 else 1.0!r} }}")
        return lines

    def sphere(self, center, radius):
        self.add("solid", f"sphere {{ {point(center)}, {SCALE * radius!r}")

    def cone(self, base, base_radius, apex, apex_radius):
        if base_radius == apex_radius:
            self.add("solid", f"cylinder {{ {point(base)}, {point(apex)}, {SCALE * base_radius!r} open")
        else:
            self.add("solid", f"cone {{ {point(base)}, {SCALE * base_radius!r}, {point(apex)}, {SCALE * apex_radius!r} open")

    def polygon(self, corners):
        points = [point(corner) for corner in corners]
        if len(points) == 3:
            self.add("mesh", f"triangle {{ {', '.join(points)} }}")
        else:
            self.add("solid", f"polygon {{ {len(points) + 1}, {', '.join(points + points[:1])}")

    def patch(self, corners):
        texts = [f"{point(position)}, {vector(normal)}" for position, normal in corners]
        for b, c in itertools.pairwise(texts[1:]):
            self.add("mesh", f"smooth_triangle {{ {texts[0]}, {b}, {c} }}")

    def add(self, kind, text):
        self.objects.append((self.texture, kind, text))

    def bodies(self):
        """Solids one by one; neighbouring triangles of one texture share a mesh."""
        lines = []
        for (texture, kind), group in itertools.groupby(self.objects, key=lambda o: o[:2]):
            finish = f"texture {{ {texture} }} interior {{ I{texture} }} }}"
            texts = [text for _, _, text in group]
            lines += [f"{text} {finish}" for text in texts] if kind == "solid" else ["mesh {", *texts, finish]
        return lines


def convert(text):
    """POV-Ray scene text for an NFF file's text."""
    return Converter().convert(text)
