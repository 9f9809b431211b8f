"""SPEC.md §13: rectangles that light comes through."""
import math
import struct

from .refused import require
from .sphere import clamp, direction_of, f32, of_unit_length, pdf32
from .tiles import sum_of

STEEPEST, THINNEST, BORDER, LEAST_LIGHT = 4096, 2.0**-12, 2.0**-22, 2.0**-48


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Portal:
    def __init__(self, data):
        *self.corner, side0, side1, self.map = struct.unpack("<5fI", data)
        self.sides = (side0, side1)


class Map:
    def __init__(self, data):
        *axes, self.unit = struct.unpack("<10f", data)
        self.axis = [axes[0:3], axes[3:6], axes[6:9]]

    def is_right(self):
        products = [dot(self.axis[i], self.axis[k]) - (i == k) for i in range(3) for k in range(i, 3)]
        return all(abs(p) <= 1e-4 for p in products) and 0 < self.unit < math.inf


class Portals:
    def __init__(self, data, visibility):
        require(visibility is not None and len(data) >= 16, 7016)
        count, map_count, self.N, self.K = struct.unpack_from("<4I", data)
        require(1 <= count <= 8 and 1 <= map_count <= count and 1 <= self.N <= 4096 and 1 <= self.K <= 4, 7016)
        maps_at = 16 + 24 * count
        sums_at, corners = maps_at + 40 * map_count, (self.N + 1)**2
        rows_at, width = sums_at + 4 * map_count * corners, 1 + count * self.K**2
        require(len(data) == rows_at + width * len(visibility.rows), 7016)
        self.portals = [Portal(data[16 + 24 * i:40 + 24 * i]) for i in range(count)]
        for portal in self.portals:
            require(all(math.isfinite(x) for x in portal.corner) and portal.map < map_count, 7017)
            require(all(0 < side < math.inf for side in portal.sides), 7017)
        self.maps = [Map(data[maps_at + 40 * i:maps_at + 40 * i + 40]) for i in range(map_count)]
        for i, one in enumerate(self.maps):
            require(one.is_right(), 7018)
            sums = struct.unpack_from(f"<{corners}I", data, sums_at + 4 * corners * i)
            one.sums = [sums[(self.N + 1) * j:(self.N + 1) * (j + 1)] for j in range(self.N + 1)]
            require(not any(one.sums[0]) and not any(row[0] for row in one.sums), 7019)
            for before, now in zip(one.sums, one.sums[1:]):
                require(all(a <= b for a, b in zip(now, now[1:])), 7019)
                steps = [a - b for a, b in zip(now, before)]
                require(all(a <= b for a, b in zip(steps, steps[1:])), 7019)
        for r, row in enumerate(visibility.rows):
            row.portals = data[rows_at + width * r:rows_at + width * (r + 1)]

    def bend(self, t):
        return 0.5 * self.N * (1 + t / (1 + abs(t)))

    def unbend(self, m):
        y = 2 * m / self.N - 1
        return y / (1 - abs(y))

    def cell(self, at):
        return min(math.floor(at), self.N - 1)

    def sum(self, one, u, v):
        i, j = self.cell(u), self.cell(v)
        below, above = one.sums[j], one.sums[j + 1]
        lower = below[i] + (u - i) * (below[i + 1] - below[i])
        upper = above[i] + (u - i) * (above[i + 1] - above[i])
        return lower + (v - j) * (upper - lower)

    def visible_portals(self, row, x):
        """What a position, x[0] to x[5], sees; None where it samples by its row alone."""
        share = (row.portals[0] + 1) / 256
        if not share < 1:
            return None
        seen = [VisiblePortal(self, k, row, x) for k in range(len(self.portals))]
        seen = [visible_portal for visible_portal in seen if 0 < visible_portal.weight < math.inf]
        return VisiblePortals(share, seen) if seen else None


class VisiblePortal:
    def __init__(self, portals, number, row, x):
        self.portals, portal = portals, portals.portals[number]
        self.map, self.weight = portals.maps[portal.map], 0.0
        axis, c = self.map.axis, [a - b for a, b in zip(portal.corner, x)]
        distance = dot(axis[2], c)
        if not distance > 0:
            return
        self.low = [dot(axis[k], c) / distance for k in range(2)]
        self.high = [(dot(axis[k], c) + portal.sides[k]) / distance for k in range(2)]
        for low, high in zip(self.low, self.high):
            if not (low > -STEEPEST and high < STEEPEST and portals.bend(high) - portals.bend(low) > THINNEST):
                return
        self.weigh(row, [dot(a, x[3:]) for a in axis], number)

    def side(self, k, i):
        if i == self.portals.K:
            return self.high[k]
        return self.low[k] + (self.high[k] - self.low[k]) * (i / self.portals.K)

    def weigh(self, row, n, number):
        of, K = self.portals, self.portals.K
        cosine, sums = {}, {}
        for i in range(K + 1):
            for j in range(K + 1):
                t, s = self.side(0, i), self.side(1, j)
                h = n[0] * t + n[1] * s + n[2]
                cosine[i, j] = h / math.sqrt(1 + t * t + s * s) if h > 0 else 0.0
                sums[i, j] = of.sum(self.map, of.bend(t), of.bend(s))
        self.w, self.D = {}, {}
        for x in range(K):
            for y in range(K):
                byte = 1 + (number * K + x) * K + y
                v = (16 + row.portals[byte] % 16) * 2.0**(row.portals[byte] // 16 - 20)
                light = sums[x + 1, y + 1] - sums[x + 1, y] - (sums[x, y + 1] - sums[x, y])
                corners = cosine[x + 1, y + 1] + cosine[x + 1, y] + (cosine[x, y + 1] + cosine[x, y])
                density = corners * (0.25 * self.map.unit) * v
                self.w[x, y] = f32(density * light) if light > LEAST_LIGHT * sums[x + 1, y + 1] else 0.0
                self.D[x, y] = f32(density) if self.w[x, y] > 0 else 0.0
        self.weight = sum_of([self.w[x, y] for x in range(K) for y in range(K)])

    def density(self, d):
        of, K, axis = self.portals, self.portals.K, self.map.axis
        z = dot(axis[2], d)
        if not z > 0:
            return 0.0
        along = [dot(axis[k], d) for k in range(2)]
        t = [a / z for a in along]
        if not all(low <= at <= high for low, at, high in zip(self.low, t, self.high)):
            return 0.0
        piece = tuple(min(math.floor((t[k] - self.low[k]) / (self.high[k] - self.low[k]) * K), K - 1)
                      for k in range(2))
        i, j = (of.cell(of.bend(at)) for at in t)
        sums = self.map.sums
        light = sums[j + 1][i + 1] - sums[j + 1][i] - (sums[j][i + 1] - sums[j][i])
        slope = (z + abs(along[0])) * (z + abs(along[1]))
        return self.D[piece] * light * (0.25 * of.N * of.N) * z / (slope * slope)

    def draw(self, x, y, u):
        of = self.portals
        sides = [(self.side(0, x), self.side(0, x + 1)), (self.side(1, y), self.side(1, y + 1))]
        low, high = [of.bend(s[0]) for s in sides], [of.bend(s[1]) for s in sides]
        u_at, i = self.invert(low[0], high[0], u[0],
                              lambda m: of.sum(self.map, m, high[1]) - of.sum(self.map, m, low[1]),
                              LEAST_LIGHT * of.sum(self.map, high[0], high[1]))

        def below(m):
            j = of.cell(m)
            step = [row[i + 1] - row[i] for row in self.map.sums[j:j + 2]]
            return step[0] + (m - j) * (step[1] - step[0])

        v_at, j = self.invert(low[1], high[1], u[1], below, 0)
        t = [inside(self.in_cell(at, cell, low[k], high[k]), *sides[k]) for k, at, cell in ((0, u_at, i), (1, v_at, j))]
        d = [t[0] * a + t[1] * b + c for a, b, c in zip(*self.map.axis)]
        length = math.sqrt(dot(d, d))
        return [f32(v / length) for v in d]

    def invert(self, low, high, u, function, least):
        """Where u of what a function grows by, linear within cells, lies before, and the cell with light there."""
        start, end = function(low), function(high)
        sought = start + u * (end - start)
        first = self.portals.cell(low)
        first = max([first] + [i for i in range(first + 1, self.portals.cell(high) + 1)
                               if function(i) <= sought and function(i) < end - least])
        a, b = max(low, first), min(high, first + 1)
        at_a, at_b = function(a), function(b)
        return a + (b - a) * clamp((sought - at_a) / (at_b - at_a), 0, 1) if at_b > at_a else a, first

    def in_cell(self, at, cell, low, high):
        """The tangent, inside of the cell's borders between low and high."""
        t = self.portals.unbend(at)
        if cell > low:
            side = self.portals.unbend(cell)
            t = max(t, side + border(side))
        if cell + 1 < high:
            side = self.portals.unbend(cell + 1)
            t = min(t, side - border(side))
        return t


def border(t):
    return BORDER * (1 + t * t)


def inside(t, low, high):
    away = border(low if abs(low) > abs(high) else high)
    return clamp(t, low + away, high - away) if high - low > 2 * away else 0.5 * (low + high)


def sample_part(weights, u):
    """The number of a part, and what is left of u."""
    x, parts = u * sum_of(weights), [i for i, w in enumerate(weights) if w > 0]
    for i in parts:
        if x < weights[i]:
            return i, clamp(x / weights[i], 0, 1)
        x -= weights[i]
    return parts[-1], 1.0


class VisiblePortals:
    def __init__(self, share, seen):
        self.share, self.seen = share, seen
        self.weight = sum_of([visible_portal.weight for visible_portal in seen])

    def density(self, direction, row):
        """With that of the row."""
        d = direction_of(direction)
        if d is None or not of_unit_length(d):
            return 0.0
        through = sum_of([visible_portal.density(d) for visible_portal in self.seen]) / self.weight
        pdf = self.share * row + (1 - self.share) * through
        return pdf32(pdf) if pdf > 0 else 0.0

    def draw(self, u):
        u = list(u)
        number, u[0] = sample_part([visible_portal.weight for visible_portal in self.seen], u[0])
        visible_portal = self.seen[number]
        K = range(visible_portal.portals.K)
        x, u[0] = sample_part([sum_of([visible_portal.w[i, j] for j in K]) for i in K], u[0])
        y, u[1] = sample_part([visible_portal.w[x, j] for j in K], u[1])
        return visible_portal.draw(x, y, u)
