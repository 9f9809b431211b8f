"""SPEC.md §5.1 to §5.3 and §7.1: what a file says of itself, and what its kind asks of that."""
import math
import struct

from .container import BRDF, ENVIRONMENT, INDEXED, LOCAL, TABLE
from .refused import require

NOT_STORED = 0xFFFFFFFF
PI = math.pi


class Axis:
    def __init__(self, data):
        self.raw_name = data[:16]
        self.role, self.measure, self.resolution, self.reserved, self.low, self.high = struct.unpack_from(
            "<IIIIdd", data, 16)
        self.name = self.raw_name.rstrip(b"\0")


class Description:
    """`axes`, `bins` (pairs of root and share, None beside HALV) and the fields of DESC."""


def is_utf8(data):
    try:
        data.decode("utf-8")
        return True
    except UnicodeDecodeError:
        return False


def read_description(container):
    data = container.payloads[b"DESC"]
    require(len(data) >= 64, 4004)
    d = Description()
    (d.parameterization, d.fit, d.filter, up, hand, axis_count, d.bin_count, d.channels, *weights,
     d.total) = struct.unpack_from("<8I4d", data)
    require(1 <= d.parameterization <= 4, 5001)
    require(1 <= d.fit <= 4, 5002)
    require(d.filter <= 1, 5003)
    require(up == 2, 5004)
    require(hand == 0, 5005)
    require(d.channels <= 2, 5019)
    require(1 <= axis_count <= 8, 5006)
    require(len(data) == 64 + 48 * axis_count, 4004)
    require(d.bin_count >= 1, 5007)
    require(all(math.isfinite(w) and w >= 0 for w in weights), 5009)
    require(math.isfinite(d.total) and d.total > 0, 5010)
    allowed = {ENVIRONMENT: (1, 4), LOCAL: (1, 4), BRDF: (2,), TABLE: (3,), INDEXED: (1, 4)}[container.kind]
    require(d.parameterization in allowed, 5016)
    d.axes = [Axis(data[64 + 48 * i:112 + 48 * i]) for i in range(axis_count)]
    check_axes(d.axes)
    check_metadata(container.payloads.get(b"META"))
    d.bins = read_bins(container.payloads, d.bin_count)
    if container.kind == ENVIRONMENT:
        check_environment(d)
    if container.kind == TABLE:
        check_table(d, weights)
    return d


def read_bins(payloads, count):
    """§7.1. Files of halvings of kinds 1 and 5 have none."""
    if b"BINS" not in payloads:
        return None
    require(len(payloads[b"BINS"]) == 8 * count, 4004)
    bins = list(struct.iter_unpack("<If", payloads[b"BINS"]))
    require(all(math.isfinite(share) and share >= 0 for _, share in bins), 6017)
    return bins


def check_axes(axes):
    for i, axis in enumerate(axes):
        name = axis.name
        require(name and b"\0" not in name and is_utf8(name), 5011)
        require(all(other.name != name for other in axes[:i]), 5011)
        require(axis.role <= 1, 5012)
        require(axis.measure <= 2, 5013)
        require(1 <= axis.resolution <= 2147483647, 5014)
        require(axis.reserved == 0, 5008)
        require(math.isfinite(axis.low) and math.isfinite(axis.high) and axis.low != axis.high, 5015)
    require(any(axis.role == 0 for axis in axes), 5012)


def check_metadata(data):
    """§5.3."""
    if data is None:
        return
    require(len(data) >= 4, 5017)
    at, keys = 4, set()
    count, = struct.unpack_from("<I", data)
    require(count <= 1024, 5017)
    for i in range(2 * count):
        require(len(data) - at >= 4, 5017)
        length, = struct.unpack_from("<I", data, at)
        text, at = data[at + 4:at + 4 + length], at + 4 + length
        require(len(text) == length and is_utf8(text), 5017)
        if i % 2 == 0:
            require(1 <= length <= 255, 5017)
            require(text not in keys, 5018)
            keys.add(text)
    require(at == len(data), 5017)


def is_axis(axis, name, role, measure, low, high, most):
    return (axis.name == name and axis.role == role and axis.measure == measure and axis.low == low and
            axis.high == high and axis.resolution <= most)


def check_sphere_axes(d):
    """§6.1 and §6.6, also of local environments."""
    if d.parameterization == 4:
        require(is_axis(d.axes[0], b"u", 0, 0, 0.0, 1.0, 65536), 7001)
        require(is_axis(d.axes[1], b"v", 0, 0, 0.0, 1.0, 65536), 7001)
        return
    require(is_axis(d.axes[0], b"phi", 0, 0, PI, -PI, 65536), 7001)
    require(is_axis(d.axes[1], b"theta", 0, 1, 0.0, PI, 65536), 7001)


def check_environment(d):
    require(len(d.axes) == 2, 7001)
    check_sphere_axes(d)
    require(d.bin_count == 1, 7002)
    require(d.bins is None or d.bins[0][1] == 1.0, 7008)


def check_table(d, weights):
    """§8."""
    indexed = [axis for axis in d.axes if axis.role == 1]
    for axis in d.axes:
        require(axis.measure == 0, 9001)
        largest = max(abs(axis.low), abs(axis.high))
        step = abs(axis.high - axis.low) / axis.resolution
        require(largest <= 2.0**100 and step >= 2.0**-100 and step >= 2.0**-40 * largest, 9004)
    require(d.axes[:len(indexed)] == indexed, 9002)
    require(d.bin_count == math.prod(axis.resolution for axis in indexed), 9003)
    require(abs(sum(share for _, share in d.bins) - 1.0) <= 2.0**-20, 9005)
    require(d.channels == 0 and weights == [1.0, 0.0, 0.0], 9006)
