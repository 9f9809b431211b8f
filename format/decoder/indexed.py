"""SPEC.md §15: environments of several maps."""
import math
import struct

from .description import check_sphere_axes
from .halvings import STEPS, Bits, Halvings, share, words
from .refused import require
from .sphere import PI, clamp, direction_of, of_unit_length, pdf32, random_number, sin_cos
from .square import grid_of

WEIGHTS = 1 << 21


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


class Map:
    def __init__(self, data):
        self.share, self.sun_share, self.radius, *self.sun = struct.unpack("<6f", data)

    def is_right(self, sun):
        length = sum(x * x for x in self.sun)
        return (math.isfinite(self.share) and self.share > 0 and 0 <= self.sun_share < 1 and (self.radius == 0 or 2.0**-10 <= self.radius <= 1) and
                (abs(length - 1) < 1e-3 if self.radius > 0 else length == 0) and
                (self.sun_share == 0 or (sun > 0 and self.radius > 0)))


def check_indexed_axes(d):
    require(len(d.axes) >= 2, 7020)
    check_sphere_axes(d)
    require(3 <= len(d.axes) <= 5, 7020)
    for axis in d.axes[2:]:
        require(axis.role == 1 and axis.measure == 0 and 2 <= axis.resolution <= 65536, 7020)
    require(d.bin_count == math.prod(axis.resolution for axis in d.axes[2:]), 7020)


class Indexed:
    """Chunks HALV and MAPS."""

    partner = None

    def __init__(self, halvings, data, d):
        self.d = d
        self.tree = Halvings(halvings, [axis.resolution for axis in d.axes[:2]])
        require(len(data) >= 16, 6036)
        count, splits, self.code_bits, self.sun = struct.unpack_from("<4I", data)
        require(count == d.bin_count and splits <= self.tree.count, 6036)
        require(4 <= self.code_bits <= 12 and self.sun <= 4, 6036)
        counts = [axis.resolution for axis in d.axes[2:]]
        maps_at = 16 + 8 * sum(counts)
        bits_at = maps_at + 24 * count
        codes_at = bits_at + 4 * words(self.tree.count)
        require(len(data) == codes_at + 4 * words(count * splits * self.code_bits), 6036)
        self.read_coordinates(data, counts)
        self.maps = [Map(data[maps_at + 24 * i:maps_at + 24 * i + 24]) for i in range(count)]
        require(all(each.is_right(self.sun) for each in self.maps), 7022)
        require(abs(sum(each.share for each in self.maps) - 1) <= 2.0**-20, 7022)
        self.read_splits(Bits(data[bits_at:codes_at]), splits)
        codes = Bits(data[codes_at:])
        self.codes = [[codes.take(self.code_bits) for _ in range(splits)] for _ in range(count)]
        require(codes.is_used_up(), 6038)

    def read_coordinates(self, data, counts):
        at, self.coordinates = 16, []
        for axis, count in zip(self.d.axes[2:], counts):
            here = list(struct.unpack_from(f"<{count}d", data, at))
            at += 8 * count
            require(all(map(math.isfinite, here)) and here[0] == axis.low and here[-1] == axis.high, 7021)
            require(all(a < b for a, b in zip(here, here[1:])), 7021)
            self.coordinates.append(here)

    def read_splits(self, bits, splits):
        """The halved nodes in preorder: `number` of those with codes of maps."""
        found, waiting = 0, [(self.tree.root, True)]
        while waiting:
            node, top = waiting.pop()
            node.number = None
            if not node.halves:
                continue
            own = bits.take(1) == 1
            require(top or not own, 6037)
            if own:
                node.number, found = found, found + 1
            waiting += [(half, own) for half in reversed(node.halves)]
        require(found == splits, 6037)
        require(bits.is_used_up(), 6038)

    def steps(self, number, code_of, node_steps):
        """Of a map: what leads to the lower half of a split."""
        code = code_of[number]
        if node_steps == 0 or code == 0:
            return 0
        if code == (1 << self.code_bits) - 1:
            return node_steps
        lower = max(node_steps * share(code, self.code_bits) >> 31, 1)
        return lower if lower < node_steps else node_steps - 1

    def at(self, coordinates):
        """§15.2: the environment at coordinates."""
        return Mixed(self, coordinates)


def before(coordinates, at):
    """The map before a coordinate, and how far it lies from there to the next."""
    if not at > coordinates[0]:
        return 0, 0.0
    if at >= coordinates[-1]:
        return len(coordinates) - 2, 1.0
    i = max(i for i in range(len(coordinates)) if coordinates[i] <= at)
    half = 0.5 if math.isinf(coordinates[i + 1] - coordinates[i]) else 1.0
    return i, (half * at - half * coordinates[i]) / (half * coordinates[i + 1] - half * coordinates[i])


def between(a, b, t):
    """On the great circle."""
    known_a, known_b = any(a), any(b)
    if not (known_a and known_b):
        return a if known_a else b
    angle = math.atan2(math.sqrt(dot(cross(a, b), cross(a, b))), dot(a, b))
    if angle < 1e-9:
        return a
    out = [math.sin((1 - t) * angle) * x + math.sin(t * angle) * y for x, y in zip(a, b)]
    length = math.sqrt(dot(out, out))
    return [x / length for x in out]


class Mixed:
    def __init__(self, file, coordinates):
        self.file, self.grid = file, grid_of(file.d)
        numbers, weights, places = [0], [1.0], []
        for axis, at in zip(file.coordinates, coordinates):
            i, t = before(axis, at)
            numbers = [n * len(axis) + i + upper for n in numbers for upper in (0, 1)]
            weights = [w * (t if upper else 1 - t) for w in weights for upper in (0, 1)]
            places.append(t)
        maps = [file.maps[n] for n in numbers]
        light = sum(w * each.share for w, each in zip(weights, maps))
        self.sun_share = sum(w * each.share * each.sun_share for w, each in zip(weights, maps)) / light
        self.total = light * file.d.total
        rest = [(n, w * each.share * (1 - each.sun_share)) for n, w, each in zip(numbers, weights, maps)]
        self.weights = self.whole([(n, v) for n, v in rest if v > 0])
        suns = [(each.sun, each.radius) for each in maps]
        for t in reversed(places):
            suns = [(between(a[0], b[0], t), a[1] + (b[1] - a[1]) * t if a[1] > 0 and b[1] > 0 else max(a[1], b[1]))
                    for a, b in zip(suns[::2], suns[1::2])]
        self.sun, radius = suns[0]
        self.reach = 2 * math.sin(radius / 2) ** 2

    @staticmethod
    def whole(weights):
        total = sum(v for _, v in weights)
        out = [max(math.floor(v / total * WEIGHTS + 0.5), 1) for _, v in weights]
        most = max(range(len(out)), key=lambda i: (weights[i][1], -i))
        out[most] += WEIGHTS - sum(out)
        return [(n, v) for (n, _), v in zip(weights, out)]

    def cone(self, x):
        """Step 6."""
        if self.sun_share == 0 or x >= 1:
            return 0.0
        k = 1 << (self.file.sun - 1)
        return k * (1 - x) ** (k - 1) / (2 * PI * self.reach)

    def place_in_cone(self, v):
        length = math.sqrt(dot(v, v))
        if self.sun_share == 0:
            return 1.0
        return sum((x / length - y) ** 2 for x, y in zip(v, self.sun)) / 2 / self.reach

    def descend(self, upper):
        """To a tile: the node, and c. `upper` is called with a split, L and c."""
        node, steps = self.file.tree.root, {n: STEPS for n, _ in self.weights}
        c = WEIGHTS * STEPS
        while node.number is not None:
            lower = {n: self.file.steps(node.number, self.file.codes[n], steps[n]) for n in steps}
            low = sum(v * lower[n] for n, v in self.weights)
            half = upper(node, low, c)
            steps = {n: steps[n] - lower[n] if half else lower[n] for n in steps}
            c = c - low if half else low
            node = node.halves[half]
        return node, c

    @staticmethod
    def probability(tile, c, cell):
        return c / 2.0**52 * (1.0 if cell is tile else cell.probability() / tile.probability())

    def pdf(self, direction):
        v = direction_of(direction)
        if not of_unit_length(v):
            return 0.0
        column, square = self.grid.grid(v)
        is_upper = lambda node: square[node.axis] >= node.halves[1].box[node.axis][0]
        tile, c = self.descend(lambda node, low, c: is_upper(node))
        cell = tile
        while cell.halves:
            cell = cell.halves[is_upper(cell)]
        t = self.grid.fractions(v, column, cell.box)
        tree = self.grid.density(cell.box, [0.0, 0.0], t, self.probability(tile, c, cell))
        pdf = self.sun_share * self.cone(self.place_in_cone(v)) + (1 - self.sun_share) * tree
        return pdf32(pdf) if pdf > 0 else 0.0

    def is_in_cone(self, u1):
        return random_number(u1) < self.sun_share

    def sample(self, u0, u1):
        u = [random_number(u0), random_number(u1)]
        direction = self.sample_cone(u) if u[1] < self.sun_share else self.sample_tree(u)
        return (*direction, self.pdf(direction))

    def sample_cone(self, u):
        x = 1 - (1 - u[1] / self.sun_share) ** (1 / (1 << (self.file.sun - 1)))
        away = x * self.reach
        sine, cosine = sin_cos(2 * u[0])
        side = cross(self.sun, [0.0, 0.0, 1.0] if abs(self.sun[2]) < 0.9 else [1.0, 0.0, 0.0])
        length = math.sqrt(dot(side, side))
        side = [y / length for y in side]
        other, r = cross(self.sun, side), math.sqrt(away * (2 - away))
        return [(1 - away) * s + r * (cosine * a + sine * b) for s, a, b in zip(self.sun, side, other)]

    def sample_tree(self, u):
        u[1] = min((u[1] - self.sun_share) / (1 - self.sun_share), 1.0)

        def upper(node, low, c):
            y = u[node.axis] * c
            half = y >= low and low < c
            u[node.axis] = (y - low) / (c - low) if half else y / low
            return half

        tile, _ = self.descend(upper)
        step = [low + min(math.floor(v * (high - low)), high - low - 1) for v, (low, high) in zip(u, tile.steps)]
        cell = tile
        while cell.halves:
            cell = cell.halves[step[cell.axis] >= cell.halves[1].steps[cell.axis][0]]
        for a, ((low, high), (first, last)) in enumerate(zip(tile.steps, cell.steps)):
            if cell is not tile:
                u[a] = clamp((u[a] * (high - low) - (first - low)) / (last - first), 0.0, 1.0)
        return self.grid.place(cell.box, u, [0.0, 0.0], 1.0)[:3]
