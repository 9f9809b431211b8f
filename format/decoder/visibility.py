"""SPEC.md §12: what of the light reaches a position."""
import math
import struct

from .halvings import share
from .refused import require
from .sphere import clamp, direction_of
from .tiles import sum_of
from .tree import LEAST

ROW, NO_COLUMN = 1 << 28, 0xFFFF


class Split:
    def __init__(self, data):
        self.position, self.blend, lower, upper = struct.unpack("<ffII", data)
        self.axis, self.part = lower & 7, (lower >> 3, upper)


class Row:
    def __init__(self, codes, columns):
        self.codes, self.columns = codes, columns


class Visibility:
    def __init__(self, data, rows):
        require(rows is not None and len(data) >= 88, 7009)
        split_count, row_count, column_count, further = struct.unpack_from("<4I", data)
        of_top, width = rows.count - 1, 1 + column_count
        require(1 <= row_count < ROW and split_count < ROW and column_count <= of_top and further < 65536, 7009)
        at = 88 + 16 * split_count
        sets = 2 * row_count if further else 0
        require(len(data) == at + 2 * (1 + further) * of_top + sets + row_count * width, 7009)
        numbers = struct.unpack_from("<18f", data, 16)
        self.low, self.high, self.transform = numbers[:3], numbers[3:6], numbers[6:]
        require(all(math.isfinite(x) for x in numbers), 7010)
        require(all(low < high for low, high in zip(self.low, self.high)), 7010)
        self.splits = [Split(data[88 + 16 * i:104 + 16 * i]) for i in range(split_count)]
        self.check_walk(row_count)
        for split in self.splits:
            require(split.axis < 6 and math.isfinite(split.position) and 0 <= split.blend < math.inf, 7012)
        columns = [struct.unpack_from(f"<{of_top}H", data, at + 2 * of_top * s) for s in range(1 + further)]
        require(all([c for c in s if c != NO_COLUMN] == list(range(column_count)) for s in columns), 7013)
        at += 2 * (1 + further) * of_top
        set_of_row = struct.unpack_from(f"<{row_count}H", data, at) if further else [0] * row_count
        require(max(set_of_row) <= further, 7015)
        at += sets
        codes = [data[at + width * r:at + width * (r + 1)] for r in range(row_count)]
        require(all(0 < code < 255 for row in codes for code in row[1:]), 7014)
        self.rows = [Row(row, columns[s]) for row, s in zip(codes, set_of_row)]
        self.tiles = rows

    def first(self):
        return 0 if self.splits else ROW

    def check_walk(self, row_count):
        waiting, due = [(self.first(), 0)], 0
        while waiting:
            node, depth = waiting.pop()
            if node & ROW:
                require(node & ~ROW < row_count, 7011)
                continue
            require(node == due < len(self.splits) and depth < 64, 7011)
            due += 1
            waiting += [(part, depth + 1) for part in reversed(self.splits[node].part)]
        require(due == len(self.splits), 7011)

    def coordinates(self, position, normal):
        """Among the cells, of the position and the normal; None outside."""
        p, t = direction_of(position), self.transform
        if p is None:
            return None
        x = [t[4 * k] * p[0] + t[4 * k + 1] * p[1] + t[4 * k + 2] * p[2] + t[4 * k + 3] for k in range(3)]
        if not all(low <= at <= high for low, at, high in zip(self.low, x, self.high)):
            return None
        length = math.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
        return x + [component / length for component in normal]

    def cells(self, position, normal):
        """Pairs of a row and its weight; none outside."""
        x = self.coordinates(position, normal)
        if x is None:
            return []
        found, i = [[self.first(), 1.0]], 0
        while i < len(found):
            while not found[i][0] & ROW:
                split = self.splits[found[i][0]]
                d = x[split.axis] - split.position
                if -split.blend < d < split.blend and len(found) < 4:
                    share = found[i][1] * ((d + split.blend) / (2 * split.blend))
                    found.append([split.part[1], share])
                    found[i] = [split.part[0], found[i][1] - share]
                else:
                    found[i][0] = split.part[1 if d >= 0 else 0]
            i += 1
        return [(self.rows[node & ~ROW], weight) for node, weight in found]

    @staticmethod
    def visibility(cells):
        return sum_of([w * ((16 + row.codes[0] % 16) * 2.0**(row.codes[0] // 16 - 20)) for row, w in cells])

    @staticmethod
    def odds(cells, split):
        """None where no cell has a column."""
        columns = [row.columns[split] for row, _ in cells]
        if all(column == NO_COLUMN for column in columns):
            return None
        return sum_of([weight * (share(row.codes[1 + column], 8) / 2.0**31 if column != NO_COLUMN else 0.5)
                       for column, (row, weight) in zip(columns, cells)])

    def descend(self, mixture, cells, choose):
        """To the last node with odds: it, its first tile and q. choose(node, low, high): whether to the upper half."""
        M, node, q = self.tiles.mixed(mixture), self.tiles.tree.root, 1.0
        first, end = 0, self.tiles.count
        while node.is_split:
            odds = self.odds(cells, node.split)
            if odds is None:
                break
            middle = self.tiles.first_tile(node.halves[1])
            lower, mass = M(middle) - M(first), M(end) - M(first)
            part = [lower * odds, (mass - lower) * (1 - odds)]
            upper = choose(node, *part)
            if not part[upper] > 0:
                return node, first, 0.0
            q = q * (part[upper] / (part[0] + part[1]))
            first, end = (middle, end) if upper else (first, middle)
            node = node.halves[upper]
        return node, first, q

    def draw(self, mixture, cells, u):
        """Changes u; returns the tile and its q."""
        def choose(node, low, high):
            x = u[node.axis] * (low + high)
            upper = int(x >= low and high > 0)
            u[node.axis] = clamp((x - low) / high if upper else x / low, 0, 1)
            return upper

        node, first, q = self.descend(mixture, cells, choose)
        M = self.tiles.mixed(mixture)
        mass = M(first + self.tiles.tiles_below(node)) - M(first)
        tile, c = self.tiles.draw_below(M, node, first, u)
        return tile, max(q * (c / mass), LEAST)

    def find(self, mixture, cells, square):
        """The tile of a square and its q."""
        M = self.tiles.mixed(mixture)
        tile = self.tiles.tile_of(square)
        node, first, q = self.descend(
            mixture, cells, lambda node, low, high: int(tile >= self.tiles.first_tile(node.halves[1])))
        c = M(tile + 1) - M(tile)
        if not (q > 0 and c > 0):
            return tile, 0.0
        return tile, max(q * (c / (M(first + self.tiles.tiles_below(node)) - M(first))), LEAST)
