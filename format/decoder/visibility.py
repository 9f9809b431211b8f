"""SPEC.md §12: what of the light reaches a position."""
import math
import struct

from .refused import require
from .sphere import clamp, direction_of
from .tiles import TILE, sum_of
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
    def __init__(self, data, tiles, bright_tile_count):
        require(tiles is not None and len(data) >= 88, 7009)
        split_count, row_count, column_count, further = struct.unpack_from("<4I", data)
        of_tiles, width = tiles.count - 1, 1 + bright_tile_count + column_count
        require(1 <= row_count < ROW and split_count < ROW and column_count <= of_tiles and further < 65536, 7009)
        at = 88 + 16 * split_count
        sets = 2 * row_count if further else 0
        require(len(data) == at + 2 * (1 + further) * of_tiles + sets + row_count * width, 7009)
        numbers = struct.unpack_from("<18f", data, 16)
        self.low, self.high, self.transform = numbers[:3], numbers[3:6], numbers[6:]
        require(all(math.isfinite(x) for x in numbers), 7010)
        require(all(low < high for low, high in zip(self.low, self.high)), 7010)
        self.splits = [Split(data[88 + 16 * i:104 + 16 * i]) for i in range(split_count)]
        self.check_walk(row_count)
        for split in self.splits:
            require(split.axis < 6 and math.isfinite(split.position) and 0 <= split.blend < math.inf, 7012)
        columns = [struct.unpack_from(f"<{of_tiles}H", data, at + 2 * of_tiles * s) for s in range(1 + further)]
        require(all([c for c in s if c != NO_COLUMN] == list(range(column_count)) for s in columns), 7013)
        at += 2 * (1 + further) * of_tiles
        set_of_row = struct.unpack_from(f"<{row_count}H", data, at) if further else [0] * row_count
        require(max(set_of_row) <= further, 7015)
        at += sets
        rows = [data[at + width * r:at + width * (r + 1)] for r in range(row_count)]
        self.odds_at, self.tiles = 1 + bright_tile_count, tiles
        require(all(0 < code < 255 for row in rows for code in row[self.odds_at:]), 7014)
        self.rows = [Row(row, columns[s]) for row, s in zip(rows, set_of_row)]

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
    def visibility(cells, index):
        return sum_of([w * ((16 + row.codes[index] % 16) * 2.0**(row.codes[index] // 16 - 20)) for row, w in cells])

    def odds(self, cells, node):
        """None where no cell has a column."""
        columns = [row.columns[node] for row, _ in cells]
        if all(column == NO_COLUMN for column in columns):
            return None
        book, at = self.tiles.codebook, self.odds_at
        return sum_of([weight * (book[row.codes[at + column]] if column != NO_COLUMN else 32767.5)
                       for column, (row, weight) in zip(columns, cells)])

    def parts(self, mixture, cells, node, v):
        """What falls into the two parts of a split, of each row and, as the position sees it, together."""
        tiles = self.tiles
        lower = [vk * (tiles.codebook[tiles.rows[row, node]] * (1 / 65535)) for vk, (row, _) in zip(v, mixture)]
        upper = [vk - lk for vk, lk in zip(v, lower)]
        low, high = sum_of(lower), sum_of(upper)
        odds = self.odds(cells, node)
        if odds is not None:
            low, high = low * odds, high * (65535 - odds)
        return (lower, upper), (low, high)

    def draw(self, mixture, cells, u):
        """Changes u; returns the tile and its q."""
        v, q, node = [w for _, w in mixture], 1.0, self.tiles.first()
        while not node & TILE:
            split = self.tiles.splits[node]
            a = split.axis
            of_rows, (low, high) = self.parts(mixture, cells, node, v)
            upper = int(u[a] * (low + high) >= low and high > 0)
            if upper:
                u[a], q = clamp((u[a] * (low + high) - low) / high, 0, 1), q * (high / (low + high))
            else:
                u[a], q = clamp(u[a] * (low + high) / low, 0, 1), q * (low / (low + high))
            v, node = of_rows[upper], split.child[upper]
        return node & ~TILE, max(q, LEAST)

    def find(self, mixture, cells, square):
        """The tile of a square and its q."""
        v, q, lit, node = [w for _, w in mixture], 1.0, bool(mixture), self.tiles.first()
        while not node & TILE:
            split = self.tiles.splits[node]
            upper = int(square[split.axis] >= split.position)
            of_rows, part = self.parts(mixture, cells, node, v)
            if part[upper] > 0:
                q = q * (part[upper] / (part[0] + part[1]))
            else:
                lit = False
            v, node = of_rows[upper], split.child[upper]
        return node & ~TILE, max(q, LEAST) if lit else 0.0
