"""SPEC.md §10.6: the fast shape of local environments."""
import math

import numpy as np

from .refused import require
from .tiles import Splits, sum_of
from .tree import LEAST

GROUP, CELLS = 16, 64


def are_ends(values, whole):
    return all(p <= q for p, q in zip(values, values[1:])) and values[-1] == whole


def steps(ends):
    """What lies between ends."""
    return [int(end) - int(before) for end, before in zip(ends, [0, *ends[:-1]])]


class FastTiles(Splits):
    """`groups` and `tiles`: of each row the steps of groups, and of tiles in theirs."""

    def __init__(self, tile, sums, grid, axes):
        super().__init__(tile, axes)
        require(self.roots is not None, 6027)
        self.read_sums(sums)
        self.read_grid(grid)

    def read_sums(self, data):
        count = (self.count + GROUP - 1) // GROUP
        padded, n = (count + 15) // 16 * 16, self.row_count
        require(len(data) == n * (2 * padded + GROUP * count), 6028)
        groups = np.frombuffer(data, "<u2", n * padded).reshape(n, padded)
        tiles = np.frombuffer(data, np.uint8, offset=2 * n * padded).reshape(n, count, GROUP)
        left = self.count - GROUP * (count - 1)  # in the last group
        self.groups, self.tiles = [], []
        for row in range(n):
            require(are_ends(groups[row], 32767) and groups[row, count - 1] == 32767, 6028)
            require(all(are_ends(ends, 255) for ends in tiles[row]) and tiles[row, -1, left - 1] == 255, 6028)
            self.groups.append(steps(groups[row][:count]))
            self.tiles.append([step for ends in tiles[row] for step in steps(ends)])

    def read_grid(self, data):
        """Of each tile its shifts, and the steps of its lines and of the cells in each."""
        self.grids, at = [], 0
        for root, box in zip(self.roots, self.boxes):
            require(root == at and at + 2 <= len(data), 6029)
            shift = data[at], data[at + 1]
            require(max(shift) <= 30, 6029)
            columns, lines = (-(-(high - low) // 2**k) for (low, high), k in zip(box, shift))
            require(max(columns, lines) <= CELLS and at + 2 + lines + lines * columns <= len(data), 6029)
            lists = [data[at + 2:at + 2 + lines]]
            for line in range(lines):
                begin = at + 2 + lines + line * columns
                lists.append(data[begin:begin + columns])
            require(all(are_ends(ends, 255) for ends in lists), 6029)
            self.grids.append((shift, steps(lists[0]), [steps(ends) for ends in lists[1:]]))
            at += 2 + lines + lines * columns
        require(data[at:] == bytes(CELLS), 6029)

    def is_dark(self, row, tile):
        return self.groups[row][tile // GROUP] == 0 or self.tiles[row][tile] == 0

    def trees(self):
        return []

    @staticmethod
    def weights(mixture):
        """Pairs of a row and its a[k]."""
        whole = sum_of([w for _, w in mixture])
        scale = 2.0**(14 - math.frexp(whole)[1])  # frexp: from 1/2 to 1
        return [(row, math.floor(w * scale) + 1) for row, w in mixture]

    def in_group(self, a, g):
        """s, and pairs of a row and its b[k]."""
        part = [(row, ak * self.groups[row][g]) for row, ak in a]
        s, n = sum(sk for _, sk in part), 0
        while s >= 2**(14 + n):
            n += 1
        return s, [(row, -(-sk // 2**n)) for row, sk in part]

    def in_tile(self, b, tile):
        return sum(bk * self.tiles[row][tile] for row, bk in b)

    @staticmethod
    def part(a, s, b, t):
        return float(s) * float(t) / (32767.0 * 255.0 * (float(sum(x for _, x in a)) * float(sum(x for _, x in b))))

    def draw(self, mixture, u):
        a = self.weights(mixture)
        masses = [sum(ak * self.groups[row][g] for row, ak in a) for g in range(len(self.groups[0]))]
        g, u[0] = sampled(masses, u[0])
        s, b = self.in_group(a, g)
        tiles = range(GROUP * g, min(GROUP * g + GROUP, self.count))
        i, u[1] = sampled([self.in_tile(b, tile) for tile in tiles], u[1])
        return tiles[i], self.part(a, s, b, self.in_tile(b, tiles[i]))

    def find(self, mixture, square):
        tile = next(k for k, box in enumerate(self.boxes)
                    if all(low <= x < high for x, (low, high) in zip(square, box)))
        if not mixture:
            return tile, 0.0
        a = self.weights(mixture)
        s, b = self.in_group(a, tile // GROUP)
        return tile, self.part(a, s, b, self.in_tile(b, tile)) if s > 0 else 0.0

    def narrow(self, tile, cell, box):
        box[:2] = [list(self.boxes[tile][0]), list(self.boxes[tile][1])]
        for axis, (i, k) in enumerate(zip(cell, self.grids[tile][0])):
            low, high = box[axis]
            box[axis] = [low + i * 2**k, min(high, low + (i + 1) * 2**k)]

    def sample_within(self, tree, tile, p, u, box, s):
        _, lines, cells = self.grids[tile]
        line, u[1] = sampled(lines, u[1])
        column, u[0] = sampled(cells[line], u[0])
        self.narrow(tile, (column, line), box)
        return max(p * (float(lines[line] * cells[line][column]) * (1 / 65025)), LEAST)

    def find_within(self, tree, tile, p, square, box, s):
        shift, lines, cells = self.grids[tile]
        column, line = (int(x - low) >> k for x, (low, _), k in zip(square, self.boxes[tile], shift))
        self.narrow(tile, (column, line), box)
        inside = lines[line] * cells[line][column]
        return max(p * (float(inside) * (1 / 65025)), LEAST) if inside > 0 else 0.0


def sampled(parts, u):
    """The first of some integers at which their sum is above u times the whole, and what is left of u."""
    whole = float(sum(parts))
    x = min(u * whole, math.nextafter(whole, 0.0))
    below = 0
    for i, part in enumerate(parts):
        if below + part > x:
            return i, (x - below) / part
        below += part
    raise AssertionError("a number beyond all parts")
