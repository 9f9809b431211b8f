"""SPEC.md §7.4, codec 2: a tree put together from its planes."""
import struct

import numpy as np

from .refused import require

SIZES = (2, 4, 1, 2, 4, 1, 2, 4, 1, 4, 2)


class Streams:
    def __init__(self, planes):
        require(len(planes) >= 44, 4005, "planes of less than 44 bytes")
        counts = struct.unpack_from("<11I", planes)
        require(44 + sum(n * size for n, size in zip(counts, SIZES)) == len(planes), 4005, "the streams' lengths")
        self.values, self.used, at = [], [0] * 11, 44
        for count, size in zip(counts, SIZES):
            # The lowest byte of every value, then the next byte of every value.
            bytes_of = np.frombuffer(planes, np.uint8, count * size, at).reshape(size, count)
            self.values.append((bytes_of.astype(np.uint64) << (8 * np.arange(size, dtype=np.uint64))[:, None]).sum(
                axis=0, dtype=np.uint64).tolist())
            at += count * size

    def next(self, stream):
        require(self.used[stream] < len(self.values[stream]), 4005, f"stream {stream} ends")
        self.used[stream] += 1
        return self.values[stream][self.used[stream] - 1]

    def are_used_up(self):
        return all(used == len(values) for used, values in zip(self.used, self.values))


class Parent:
    def __init__(self, start, links, link_size, n, children):
        self.start, self.links, self.link_size, self.n = start, links, link_size, n
        self.children = children[::-1]


def link(tree, stack):
    """Step 1."""
    parent = stack[-1]
    segment, distance = parent.children.pop(), (len(tree) - parent.start) // 2
    require(segment < parent.n and distance < 1 << 8 * parent.link_size, 4005, "a child")
    at = parent.links + segment * parent.link_size
    require(not any(tree[at:at + parent.link_size]), 4005, "a segment has two children")
    tree[at:at + parent.link_size] = distance.to_bytes(parent.link_size, "little")
    if not parent.children:
        stack.pop()


def align(tree, size):
    tree.extend(bytes(-len(tree) % size))


def tree_of_planes(planes, raw_length):
    streams, tree, stack = Streams(planes), bytearray(), []
    while len(tree) < raw_length:
        if stack:
            link(tree, stack)
        start, h = len(tree), streams.next(0)  # step 2
        tree += h.to_bytes(2, "little")
        n = h >> 10
        if n == 0:  # step 3
            n = streams.next(1)
            require(n != 0, 4005, "no segments")
            tree += n.to_bytes(4, "little")
        for first, code in ((2, h >> 3 & 3), (5, h >> 5 & 3)):  # step 4
            require(code < 3, 4005, "a code of 3")
            size, total = 1 << code, 0
            align(tree, size)
            for _ in range(n - 1):
                total = (total + streams.next(first + code)) % (1 << 8 * size)
                tree += total.to_bytes(size, "little")
        if h >> 7 & 3:  # step 5
            size = 1 << (h >> 7 & 3) - 1
            align(tree, size)
            links, s = len(tree), 8 if n <= 255 else 9
            require(n * size <= raw_length, 4005, "links beyond the end")
            tree += bytes(n * size)
            children = [streams.next(s) for _ in range(streams.next(s))]
            if children:
                require(len(stack) < 64, 4005, "more than 64 curves wait")
                stack.append(Parent(start, links, size, n, children))
        align(tree, 2)  # step 6
        if h >> 9 & 1:
            for _ in range(n):
                tree += streams.next(10).to_bytes(2, "little")
    require(len(tree) == raw_length and not stack and streams.are_used_up(), 4005, "the end")
    return bytes(tree)
