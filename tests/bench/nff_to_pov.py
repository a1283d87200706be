"""NFF scenes as POV-Ray 3.7 scenes of the same picture: used by `peers` to time POV-Ray beside RayEngine."""

import itertools

# POV-Ray drops hits nearer than 1e-4, which small scenes need: a power of two enlarges them without rounding.
SCALE = 1024.0


def tokens(text):
    for line in text.splitlines():
        yield from line.split("#", 1)[0].split()


class Reader:
    """The tokens of an NFF file, with numbers taken in groups."""

    def __init__(self, text):
        self.items = list(tokens(text))
        self.at = 0

    def word(self):
        self.at += 1
        return self.items[self.at - 1]

    def more(self):
        return self.at < len(self.items)

    def numbers(self, count):
        values = [float(item) for item in self.items[self.at:self.at + count]]
        self.at += count
        return values

    def point(self):
        return vector(SCALE * x for x in self.numbers(3))

    def number_next(self):
        return self.more() and (self.items[self.at][0].isdigit() or self.items[self.at][0] in "+-.")


def vector(values):
    return "<" + ",".join(repr(v) for v in values) + ">"


class Converter:
    def __init__(self, text):
        self.reader = Reader(text)
        self.textures = {}
        self.texture = None
        self.head = ["#version 3.7;", "global_settings { assumed_gamma 1 max_trace_level 5 ambient_light rgb 0 }"]
        self.lights = []
        self.objects = []  # (texture, "mesh" for what a mesh can hold, text)

    def convert(self):
        entities = {"v": self.view, "b": self.background, "l": self.light, "f": self.fill, "s": self.sphere,
                    "c": self.cone, "p": self.polygon, "pp": self.patch}
        while self.reader.more():
            entities[self.reader.word()]()
        return "\n".join(self.head + self.light_sources() + self.declarations() + self.bodies()) + "\n"

    def view(self):
        r = self.reader
        words = {}
        for _ in range(6):
            key = r.word()
            words[key] = r.numbers({"angle": 1, "hither": 1, "resolution": 2}.get(key, 3))
        at, eye = (vector(SCALE * x for x in words[k]) for k in ("at", "from"))
        # `right -x` makes the coordinates right-handed, as NFF's are.
        self.head.append(f"camera {{ perspective location {eye} sky {vector(words['up'])} up y right -x "
                         f"angle {words['angle'][0]!r} look_at {at} }}")

    def background(self):
        self.head.append(f"background {{ rgb {vector(self.reader.numbers(3))} }}")

    def light(self):
        position = self.reader.point()
        self.lights.append((position, self.reader.numbers(3) if self.reader.number_next() else None))

    def light_sources(self):
        each = [1 / len(self.lights) ** 0.5] * 3 if self.lights else None
        return [f"light_source {{ {at} rgb {vector(color or each)} }}" for at, color in self.lights]

    def fill(self):
        key = tuple(self.reader.numbers(8))
        self.texture = self.textures.setdefault(key, f"T{len(self.textures)}")

    def declarations(self):
        lines = []
        for (r, g, b, kd, ks, shine, transmit, ior), name in self.textures.items():
            lines.append(f"#declare {name} = texture {{ pigment {{ rgbf {vector((r, g, b, transmit))} }} finish {{ ambient 0 "
                         f"diffuse {kd!r} phong {ks!r} phong_size {shine!r} reflection {ks!r} }} }}")
            lines.append(f"#declare I{name} = interior {{ ior {ior if transmit > 0 and ior > 0 else 1.0!r} }}")
        return lines

    def sphere(self):
        center = self.reader.point()
        self.add("solid", f"sphere {{ {center}, {abs(SCALE * self.reader.numbers(1)[0])!r}")

    def cone(self):
        r = self.reader
        base, r0 = r.point(), abs(SCALE * r.numbers(1)[0])
        apex, r1 = r.point(), abs(SCALE * r.numbers(1)[0])
        if r0 == r1:
            self.add("solid", f"cylinder {{ {base}, {apex}, {r0!r} open")
        else:
            self.add("solid", f"cone {{ {base}, {r0!r}, {apex}, {r1!r} open")

    def polygon(self):
        count = int(self.reader.numbers(1)[0])
        points = [self.reader.point() for _ in range(count)]
        if count == 3:
            self.add("mesh", f"triangle {{ {', '.join(points)} }}")
        else:
            self.add("solid", f"polygon {{ {count + 1}, {', '.join(points + points[:1])}")

    def patch(self):
        r = self.reader
        corners = [f"{r.point()}, {vector(r.numbers(3))}" for _ in range(int(r.numbers(1)[0]))]
        for b, c in itertools.pairwise(corners[1:]):
            self.add("mesh", f"smooth_triangle {{ {corners[0]}, {b}, {c} }}")

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
    return Converter(text).convert()
