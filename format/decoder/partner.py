"""SPEC.md §5.4: what a file is not to be used without."""
import math
import struct

from .container import LOCAL, TABLE
from .refused import require


class Partner:
    def __init__(self, data, kind, bin_count):
        require(len(data) >= 24, 5020)
        self.kind, self.heuristic, self.share, self.recommended_light_share, count, reserved = struct.unpack_from("<IIffII", data)
        require(len(data) == 24 + 8 * count, 5020)
        require(count == bin_count or (count == 0 and kind != LOCAL), 5020)
        require(reserved == 0 and 0 < self.share < 1 and 0 < self.recommended_light_share <= 1, 5020)
        require(1 <= self.kind <= 4 and (self.kind == 4) == (kind == TABLE), 5021)
        require(self.heuristic <= 1, 5021)
        self.records = list(struct.iter_unpack("<ff", data[24:]))
        for share, flux in self.records:
            require(0 < share <= 1 and flux >= 0 and math.isfinite(flux) and (flux == 0 or kind == LOCAL), 5020)
