"""SPEC.md §1 to §4: the header, the table of chunks, and what their bytes inflate to."""
import struct
import zlib

from .planes import tree_of_planes
from .refused import Refused, require

MAGIC = bytes.fromhex("AB4143444620 20BB0D0A1A0A".replace(" ", ""))
ENVIRONMENT, LOCAL, BRDF, TABLE, INDEXED = 1, 2, 3, 4, 5
INFLATED_LIMIT = 1 << 30
# Of each known chunk: its flags, and the kinds in whose files it may be.
KNOWN = {b"DESC": (1, (1, 2, 3, 4, 5)), b"BINS": (1, (1, 2, 3, 4, 5)), b"TREE": (1, (1, 2, 3, 5)),
         b"META": (0, (1, 2, 3, 4, 5)), b"TILE": (1, (2,)), b"ROWS": (1, (2,)), b"VIEW": (1, (3,)),
         b"LOCL": (1, (2,)), b"COMP": (1, (1, 2, 4)), b"PLAC": (0, (2,)), b"PORT": (0, (2,)),
         b"HALV": (1, (1, 2, 3, 4, 5)), b"MAPS": (1, (5,)), b"NORM": (1, (2, 3))}

__all__ = ["Refused", "Container", "read_container"]


class Container:
    """The kind of a file and the payloads of its known chunks."""

    def __init__(self, kind, payloads):
        self.kind = kind
        self.payloads = payloads


def round_up(n):
    return (n + 63) // 64 * 64


def read_container(data):
    data = bytes(data)
    kind, table = read_header(data)
    records = [Record(table[48 * i:48 * i + 48]) for i in range(len(table) // 48)]
    check_records(data, kind, records)
    payloads, inflated = {}, 0
    for record in records:
        stored = data[record.offset:record.offset + record.stored_length]
        require(zlib.crc32(stored) == record.crc, 4001, record.type)
        if record.type not in KNOWN:
            continue
        if record.codec != 0:
            inflated += record.raw_length
            require(inflated <= INFLATED_LIMIT, 3012, record.type)
        payloads[record.type] = inflate(stored, record)
    return Container(kind, payloads)


def read_header(data):
    """§2. Returns the kind and the bytes of the chunk table."""
    require(data[:12] == MAGIC[:len(data[:12])], 2002)
    require(len(data) >= 64, 2001)
    major, _minor, length, kind, required, _optional, count = struct.unpack_from("<HHQIIII", data, 12)
    crc, = struct.unpack_from("<I", data, 60)
    require(major == 1, 2003)
    require(1 <= count <= 64 and 64 + 48 * count <= len(data), 3001)
    table = data[64:64 + 48 * count]
    require(crc == zlib.crc32(data[:60] + table), 2004)
    require(length == len(data), 2005)
    require(1 <= kind <= 5, 2006)
    require(required == 0, 2007)
    require(data[40:60] == bytes(20), 2008)
    return kind, table


class Record:
    """§3: a record of the chunk table."""

    def __init__(self, data):
        (self.type, self.flags, self.codec, self.crc, self.offset, self.stored_length, self.raw_length,
         self.reserved) = struct.unpack("<4sIIIQQQQ", data)


def check_records(data, kind, records):
    end = 64 + 48 * len(records)
    seen = set()
    for record in records:
        known = record.type in KNOWN
        require(all(0x20 <= c <= 0x7E for c in record.type), 3014)
        require(known or record.flags & 1 == 0, 3002, record.type)
        require(record.type not in seen, 3003, record.type)
        seen.add(record.type)
        require(record.codec in ((0, 1, 2) if record.type == b"TREE" else (0, 1)), 3005)
        require(record.flags & ~1 == 0 and record.reserved == 0, 3009)
        require(not known or record.flags == KNOWN[record.type][0], 3009)
        require(not known or kind in KNOWN[record.type][1], 3013)
        require(record.offset == round_up(end), 3006)
        require(record.offset <= len(data) and record.stored_length <= len(data) - record.offset, 3007)
        require(record.codec != 0 or record.raw_length == record.stored_length, 3010)
        require(record.codec == 0 or record.raw_length < 1032 * (record.stored_length + 1), 3011)
        require(not any(data[end:record.offset]), 4002)
        end = record.offset + record.stored_length
    beside_halvings = {ENVIRONMENT: (b"DESC",), LOCAL: (b"DESC", b"BINS", b"NORM"),
                       BRDF: (b"DESC", b"BINS", b"NORM")}
    curves = (b"DESC", b"BINS", b"TREE")
    for wanted in ((b"DESC", b"HALV", b"MAPS") if kind == INDEXED else
                   (b"DESC", b"HALV", b"BINS") if kind == TABLE else
                   beside_halvings.get(kind, curves) if b"HALV" in seen else curves):
        require(wanted in seen, 3004, wanted)
    require(len(data) == round_up(end), 3008)
    require(not any(data[end:]), 4002)


def inflate(stored, record):
    """§4."""
    if record.codec == 0:
        return stored
    rule = 4003 if record.codec == 1 else 4005
    most = record.raw_length if record.codec == 1 else 2 * record.raw_length + 44
    stream = zlib.decompressobj()
    try:
        raw = stream.decompress(stored, most + 1)
    except zlib.error as error:
        raise Refused(rule, str(error)) from error
    require(len(raw) <= most and stream.eof and not stream.unused_data, rule)
    if record.codec == 2:
        return tree_of_planes(raw, record.raw_length)
    require(len(raw) == record.raw_length, 4003)
    return raw
