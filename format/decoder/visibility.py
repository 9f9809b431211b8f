"""SPEC.md §12: what of the light reaches a position."""
import math
import struct

from .halvings import share
from .refused import require
from .sphere import clamp, direction_of
from .tree import LEAST

ROW, UNSEEN = 1 << 28, 2.0**-6


class Split:
    def __init__(self, data):
        self.position, lower, upper = struct.unpack("<fII", data)
        self.axis, self.part = lower & 7, (lower >> 3, upper)


class Column:
    def __init__(self, data):
        self.tile, parts = struct.unpack("<HH", data)
        self.upper, self.is_lower_parted = parts & 0x7FFF, not parts & 0x8000


class Row:
    def __init__(self, codes, columns):
        self.codes, self.columns = codes, columns


class Visibility:
    def __init__(self, data, rows):
        require(rows is not None and len(data) >= 88, 7009)
        split_count, row_count, column_count, further = struct.unpack_from("<4I", data)
        width, set_bytes = 1 + column_count, 4 * column_count
        require(1 <= row_count < ROW and split_count < ROW and further < 65536, 7009)
        require(column_count <= rows.count - 1 and column_count < 1 << 15, 7009)
        at = 88 + 12 * split_count
        names = 2 * row_count if further else 0
        require(len(data) == at + set_bytes * (1 + further) + names + row_count * width, 7009)
        numbers = struct.unpack_from("<18f", data, 16)
        self.low, self.high, self.transform = numbers[:3], numbers[3:6], numbers[6:]
        require(all(math.isfinite(x) for x in numbers), 7010)
        require(all(low < high for low, high in zip(self.low, self.high)), 7010)
        self.splits = [Split(data[88 + 12 * i:100 + 12 * i]) for i in range(split_count)]
        self.check_walk(row_count)
        for split in self.splits:
            require(split.axis < 6 and math.isfinite(split.position), 7012)
        sets = []
        for _ in range(1 + further):
            sets.append([Column(data[at + 4 * k:at + 4 * k + 4]) for k in range(column_count)])
            require(self.are_columns(sets[-1], rows.count), 7013)
            at += set_bytes
        set_of_row = struct.unpack_from(f"<{row_count}H", data, at) if further else [0] * row_count
        require(max(set_of_row) <= further, 7015)
        at += names
        codes = [data[at + width * r:at + width * (r + 1)] for r in range(row_count)]
        require(all(0 < code < 255 for row in codes for code in row[1:]), 7014)
        self.rows = [Row(row, sets[s]) for row, s in zip(codes, set_of_row)]
        self.tiles = rows

    @staticmethod
    def are_columns(columns, tiles):
        waiting, due = [(0, 0, tiles, 1)] if columns else [], 0
        while waiting:
            number, first, end, depth = waiting.pop()
            if number != due or due == len(columns) or depth > 64:
                return False
            column, due = columns[due], due + 1
            if not first < column.tile < end:
                return False
            if column.upper:
                waiting.append((column.upper, column.tile, end, depth + 1))
            if column.is_lower_parted:
                waiting.append((due, first, column.tile, depth + 1))
        return due == len(columns)

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

    def cell(self, position, normal):
        """A row; None outside."""
        x = self.coordinates(position, normal)
        if x is None:
            return None
        node = self.first()
        while not node & ROW:
            split = self.splits[node]
            node = split.part[1 if x[split.axis] >= split.position else 0]
        return self.rows[node & ~ROW]

    def descend(self, M, row, choose):
        """To tiles [first, end) that no column parts: these and q. choose(column, lo, hi): the side."""
        first, end, q, number = 0, self.tiles.count, 1.0, 0 if row.columns else None
        while number is not None:
            column, odds = row.columns[number], share(row.codes[1 + number], 8) / 2.0**31
            lower = M(column.tile) - M(first)
            part = [lower * odds, (M(end) - M(first) - lower) * (1 - odds)]
            upper = choose(column, *part)
            if not part[upper] > 0:
                return first, end, 0.0
            q = q * (part[upper] / (part[0] + part[1]))
            if upper:
                first, number = column.tile, column.upper or None
            else:
                end, number = column.tile, number + 1 if column.is_lower_parted else None
        return first, end, q

    def q(self, M, row, tile):
        first, end, q = self.descend(M, row, lambda column, lo, hi: int(tile >= column.tile))
        q = q * ((M(tile + 1) - M(tile)) / (M(end) - M(first))) if q > 0 else 0.0
        q = (1 - UNSEEN) * q + UNSEEN * ((M(tile + 1) - M(tile)) / 2.0**52)
        return max(q, LEAST) if q > 0 else 0.0

    def draw(self, mixture, row, u):
        """Changes u; returns the tile and its q."""
        def choose(column, lo, hi):
            x = u[0] * (lo + hi)
            upper = int(x >= lo and hi > 0)
            u[0] = clamp((x - lo) / hi if upper else x / lo, 0, 1)
            return upper

        M = self.tiles.mixed(mixture)
        if u[0] < UNSEEN:
            u[0] = u[0] / UNSEEN
            tile, _ = self.tiles.draw(mixture, u)
            return tile, self.q(M, row, tile)
        u[0] = (u[0] - UNSEEN) / (1 - UNSEEN)
        first, end, _ = self.descend(M, row, choose)
        x = u[1] * float(M(end) - M(first))
        k = min(math.floor(x), M(end) - M(first) - 1)
        tile = max(t for t in range(first, end) if M(t) - M(first) <= k)
        u[1] = clamp((x - (M(tile) - M(first))) / (M(tile + 1) - M(tile)), 0, 1)
        return tile, self.q(M, row, tile)

    def find(self, mixture, row, square):
        """The tile of a square and its q."""
        tile = self.tiles.tile_of(square)
        return tile, self.q(self.tiles.mixed(mixture), row, tile)
