"""The tokens and entities of NFF files, for the scripts that write them anew for other programs."""


def tokens(text):
    for line in text.splitlines():
        yield from line.split("#", 1)[0].split()


class Reader:
    """Reads a file's entities in order, calling the method of each: view, background, light, fill, sphere, cone, polygon,
    patch. Numbers are floats, points lists of three."""

    def read(self, text):
        self.items = list(tokens(text))
        self.at = 0
        entities = {"v": self.read_view, "b": lambda: self.background(self.numbers(3)), "l": self.read_light,
                    "f": lambda: self.fill(*self.numbers(8)), "s": lambda: self.sphere(self.numbers(3), abs(self.number())),
                    "c": self.read_cone, "p": self.read_polygon, "pp": self.read_patch}
        while self.at < len(self.items):
            entities[self.word()]()

    def word(self):
        self.at += 1
        return self.items[self.at - 1]

    def number(self):
        return float(self.word())

    def numbers(self, count):
        return [self.number() for _ in range(count)]

    def number_next(self):
        return self.at < len(self.items) and (self.items[self.at][0].isdigit() or self.items[self.at][0] in "+-.")

    def read_view(self):
        words = {}
        for _ in range(6):
            key = self.word()
            words[key] = self.numbers({"angle": 1, "hither": 1, "resolution": 2}.get(key, 3))
        self.view(words["from"], words["at"], words["up"], words["angle"][0])

    def read_light(self):
        position = self.numbers(3)
        self.light(position, self.numbers(3) if self.number_next() else None)

    def read_cone(self):
        base, base_radius = self.numbers(3), abs(self.number())
        self.cone(base, base_radius, self.numbers(3), abs(self.number()))

    def read_polygon(self):
        self.polygon([self.numbers(3) for _ in range(int(self.number()))])

    def read_patch(self):
        self.patch([(self.numbers(3), self.numbers(3)) for _ in range(int(self.number()))])
