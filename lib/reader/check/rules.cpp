#include "check/rules.h"

namespace acdf {

namespace {
constexpr Severity error = Severity::error;
constexpr Severity warning = Severity::warning;
constexpr ErrorCode malformed = ErrorCode::malformed;
constexpr ErrorCode unsupported = ErrorCode::unsupported;
} // namespace

// Ascending by number. SPEC.md §8 carries the same table; a test compares the two.
const Rule rules[] = {
    {1001, error, ErrorCode::cannot_open, "open", "The file can be opened for reading."},
    {1002, error, ErrorCode::cannot_read, "read", "The file is a regular file and all its bytes can be read."},
    {1003, error, ErrorCode::out_of_memory, "memory",
     "There is memory for the file, its inflated chunks and the checks."},
    {1004, error, ErrorCode::limit_exceeded, "file-limit", "The file is no larger than the reader's limit."},

    {2001, error, malformed, "header-size", "The file holds a whole header of 64 bytes."},
    {2002, error, malformed, "magic", "The file starts with the 12 bytes of the magic."},
    {2003, error, unsupported, "version", "The major version is 1."},
    {2004, error, malformed, "header-crc", "`header_crc` is the CRC-32 of bytes 0 to 59 and of the chunk table."},
    {2005, error, malformed, "file-length", "`file_length` is the size of the file."},
    {2006, error, unsupported, "kind", "`kind` is one of those of §2.1."},
    {2007, error, unsupported, "required-feature", "No bit of `required_features` is set."},
    {2008, error, malformed, "header-reserved", "The reserved bytes of the header are zero."},

    {3001, error, malformed, "chunk-count", "There are 1 to 64 chunks and the file holds their whole table."},
    {3002, error, unsupported, "critical-chunk", "A critical chunk is of a known type."},
    {3003, error, malformed, "duplicate-chunk", "No two chunks are of one type."},
    {3004, error, malformed, "missing-chunk", "The chunks DESC, BINS and TREE are there."},
    {3005, error, unsupported, "codec", "`codec` is 0 (none), 1 (zlib) or, of TREE, 2 (planes)."},
    {3006, error, malformed, "chunk-offset",
     "A payload starts at the first multiple of 64 after what comes before it, in the table's order."},
    {3007, error, malformed, "chunk-bounds", "A payload lies inside the file."},
    {3008, error, malformed, "file-end", "`file_length` is the end of the last payload, rounded up to 64."},
    {3009, error, malformed, "chunk-flags",
     "Only flag bit 0 may be set; it is clear for META, PLAC and PORT and set for all other known types; "
     "`reserved` is "
     "zero."},
    {3010, error, malformed, "raw-length", "With codec 0, `raw_length` equals `stored_length`."},
    {3011, error, malformed, "deflate-ratio",
     "With codec 1 or 2, `raw_length` is less than 1032 (`stored_length` + 1)."},
    {3012, error, ErrorCode::limit_exceeded, "inflate-limit",
     "The compressed chunks, but for unknown ones, inflate to no more than the reader's limit."},
    {3013, error, malformed, "chunk-kind",
     "TILE and ROWS come only in files of kinds 2 and 3, LOCL, SUMS, GRID, PLAC and PORT only in those of kind 2, "
     "VIEW only in "
     "those of kind 3, COMP in all but those."},
    {3014, error, malformed, "chunk-type", "The type of a chunk is four printable ASCII characters."},

    {4001, error, malformed, "chunk-crc", "`crc` is the CRC-32 of the stored bytes."},
    {4002, error, malformed, "padding", "The bytes between payloads and after the last one are zero."},
    {4003, error, malformed, "zlib-stream",
     "With codec 1, the stored bytes are one whole zlib stream of `raw_length` bytes."},
    {4004, error, malformed, "payload-length",
     "DESC is 64 + 48 `axis_count` bytes long and BINS is 8 `bin_count` bytes long."},
    {4005, error, malformed, "planes",
     "With codec 2, the stored bytes are one whole zlib stream of the planes of a tree of `raw_length` bytes."},

    {5001, error, unsupported, "parameterization", "`parameterization` is one of those of §5.1."},
    {5002, error, unsupported, "fit", "`fit` is one of those of §5.1."},
    {5003, error, unsupported, "filter", "`filter` is one of those of §5.1."},
    {5004, error, unsupported, "up-axis", "`up_axis` is 2 (z)."},
    {5005, error, unsupported, "handedness", "`handedness` is 0 (right-handed)."},
    {5006, error, malformed, "axis-count", "`axis_count` is 1 to 8."},
    {5007, error, malformed, "bin-count", "`bin_count` is at least 1."},
    {5008, error, malformed, "description-reserved", "The reserved fields of DESC are zero."},
    {5009, error, malformed, "channel-weights", "The channel weights are finite and not negative."},
    {5010, error, malformed, "total", "`total` is finite and positive."},
    {5011, error, malformed, "axis-name",
     "The name of an axis is UTF-8, not empty, padded with zero bytes, and no other axis has it."},
    {5012, error, malformed, "axis-role",
     "`role` is 0 (sampled) or 1 (indexed), and one axis at least is sampled."},
    {5013, error, malformed, "axis-measure", "`measure` is 0 (linear) or 1 (cosine)."},
    {5014, error, malformed, "axis-resolution", "`resolution` is 1 to 2147483647."},
    {5015, error, malformed, "axis-range", "`low` and `high` are finite and differ."},
    {5016, error, malformed, "parameterization-kind", "The parameterization is that of the kind."},
    {5017, error, malformed, "metadata",
     "META is as §5.5 says: lengths within the chunk, nothing left over, at most 1024 pairs, "
     "keys of 1 to 255 bytes, all UTF-8."},
    {5018, error, malformed, "duplicate-key", "No two metadata keys are equal."},
    {5019, error, unsupported, "channels", "`channels` is one of those of §5.1."},
    {5020, error, malformed, "partner",
     "COMP is as long as its count says, with a record for each bin or, but for local environments, none; "
     "`reserved` is zero, `share` in (0, 1), recommended shares in (0, 1], fluxes finite, not negative, and 0 but "
     "in "
     "local environments."},
    {5021, error, unsupported, "partner-kind",
     "Kind and heuristic of an MIS partner are those of §5.8; that of a table is 4, and no other's."},

    {6001, error, malformed, "tree-length", "TREE is 1 to 4294967294 units of two bytes long."},
    {6002, error, malformed, "curve-end", "A curve ends inside TREE."},
    {6003, error, malformed, "curve-axis", "The axis of a curve is a sampled axis."},
    {6004, error, malformed, "curve-header",
     "The codes of cumulative values and of positions in a curve's header are 0, 1 or 2."},
    {6005, error, malformed, "curve-segments",
     "A curve has 1 to 1048575 segments; the long form of the count is for more than 63."},
    {6006, error, malformed, "knot-order", "The positions of a curve are strictly increasing."},
    {6007, error, malformed, "knot-range",
     "The positions of a curve lie strictly inside the range of its axis, on every path to the curve."},
    {6008, error, malformed, "cumulative-order", "The cumulative values of a curve never decrease."},
    {6009, error, malformed, "link", "A link leads to the start of a later curve."},
    {6010, error, malformed, "root", "The root of a bin that has a tree of its own is the start of a curve."},
    {6011, error, malformed, "curve-padding", "The padding inside and after a curve is zero."},
    {6012, warning, ErrorCode::none, "unreachable-curve",
     "A curve is reached from a root (else its bytes are wasted)."},
    {6013, error, malformed, "tilt", "No tilt is -32768."},
    {6014, error, malformed, "tilt-split", "Below a segment of nonzero tilt no curve is on the same axis."},
    {6015, error, malformed, "dark-link", "A segment of probability 0 ends."},
    {6016, error, malformed, "depth", "A path from a root to a cell passes at most 64 curves."},
    {6017, error, malformed, "bin-share", "`share` is finite and not negative."},
    {6018, error, malformed, "curve-count", "TREE of n bytes holds at most n / 4 + 1 curves."},
    {6019, error, malformed, "relative-knots",
     "If the knots of a curve have one-byte positions, its range begins at the same position on every path to it."},
    {6020, error, malformed, "tiles",
     "TILE is as long as its counts say: 1 to 32768 tiles, and a root for each of them or none; `reserved` is "
     "zero."},
    {6021, error, malformed, "codebook", "The codebook rises strictly from 0 to 65535."},
    {6022, error, malformed, "splits",
     "Splits stand in preorder, at most 48 on a path, and tiles are numbered in the order of the walk: each is met "
     "once."},
    {6023, error, malformed, "split-position",
     "A split is on axis 0 or 1, its position strictly inside the box that it divides."},
    {6024, error, malformed, "tile-root", "The root of a tile is the start of a curve, or FFFFFFFF."},
    {6025, error, malformed, "rows", "ROWS comes with TILE, and holds `row_count` rows of a byte a split."},
    {6026, error, malformed, "bin-row",
     "The row of a bin is one of ROWS, of SUMS where there is that, or FFFFFFFF."},
    {6027, error, malformed, "fast-shape",
     "SUMS and GRID come together, with TILE and roots of its tiles, and without ROWS, PLAC and PORT."},
    {6028, error, malformed, "sums",
     "SUMS has `row_count` rows. Ends of groups never decrease up to 32767, those of the tiles of a group up to "
     "255, and "
     "nothing behind the last group and tile has a share."},
    {6029, error, malformed, "grid",
     "GRID has the grids of all tiles without gaps, each at its root, with shifts of at most 30 and 1 to 64 cells "
     "an "
     "axis, and behind them 64 zero bytes. The ends of a list never decrease up to 255."},

    {6030, error, malformed, "halvings",
     "HALV is as long as its counts say, codes have 2 to 12 bits, and its reserved fields are zero."},
    {6031, error, malformed, "halved-nodes", "`halving_count` nodes of HALV are halved, and every half is there."},
    {6032, error, malformed, "halved-axis", "A node is halved on a sampled axis that it has two steps or more of."},
    {6033, error, malformed, "halved-numbers",
     "A node that no random number leads to is a leaf; one with a code between the first and the last is reached "
     "by two "
     "steps of random numbers or more on its axis."},
    {6034, error, malformed, "halvings-padding", "The padding of HALV is zero."},
    {6035, error, malformed, "halvings-alone", "HALV comes without BINS and TREE, and with fit 4."},
    {7001, error, malformed, "environment-axes",
     "An environment, local or not, has the two axes of §6.1 first, with parameterization 4 those of §6.9, with "
     "resolutions of at most 65536; one that is not local has no others."},
    {7002, error, malformed, "environment-bins", "An environment has one bin."},
    {7003, error, malformed, "normal-axes",
     "A local environment has the axes of an environment, and one or two of normals as in §6.7."},
    {7004, error, malformed, "normal-bins", "A local environment has as many bins as its normals' axes make."},
    {7005, error, malformed, "local-chunk",
     "A local environment has LOCL, as long as its count of bright tiles says, at most 64; `cosine_share` is in "
     "[0, "
     "1)."},
    {7006, error, malformed, "bright-tile",
     "A light is a tile, in ascending order, with the tile's box, a unit direction, a radius in (0, 2] and a "
     "positive finite share."},
    {7007, error, malformed, "bright-tile-row",
     "In the row of a bin of positive share a light's tile has probability 0."},
    {7008, error, malformed, "environment-share", "The share of an environment's bin is 1."},
    {7009, error, malformed, "visibility",
     "PLAC comes with TILE and is as long as its counts say, with at least one row."},
    {7010, error, malformed, "visibility-bounds",
     "The bounds of visibility cells are finite and rise, and the transform is finite."},
    {7011, error, malformed, "visibility-splits",
     "Splits of visibility cells stand in preorder, at most 64 on a path, each met once, and lead to rows that are "
     "there."},
    {7012, error, malformed, "visibility-split",
     "A split of visibility cells is on one of axes 0 to 5, its position finite, its blend finite and not "
     "negative."},
    {7013, error, malformed, "visibility-columns",
     "The columns of splits of tiles are numbered from 0 in their order, all of them in each set; FFFF where a "
     "split has none."},
    {7014, error, malformed, "visibility-odds", "No odds of a cell are 0 or 255: no part of the light has none."},
    {7015, error, malformed, "visibility-sets",
     "The set of columns that a row of visibility cells names is there."},
    {7016, error, malformed, "portals",
     "PORT comes with PLAC and is as long as its counts say: 1 to 8 portals, 1 to as many maps, of 1 to 4096 "
     "cells "
     "along each axis, and 1 to 4 pieces along each side."},
    {7017, error, malformed, "portal",
     "The corner of a portal is finite, its sides are positive and finite, and its map is there."},
    {7018, error, malformed, "portal-map",
     "The axes of a map of portals are unit and at right angles; its unit is positive and finite."},
    {7019, error, malformed, "portal-sums",
     "The sums of a map begin with a row and a column of 0, and no cell between them has less than 0."},

    {8001, error, malformed, "brdf-axes",
     "A BRDF has the axes of §6.8, cos_theta_h of at most 268435456 steps and the others of at most 65536."},
    {8002, error, malformed, "brdf-bins", "A BRDF has as many bins as the product of its axes of views."},
    {8003, error, malformed, "views",
     "A BRDF has VIEW, as long as `theta_count` says, with the counts of the axes; only flag bit 0 may be set, "
     "where `phi_count` is 1, and phi_h begins at 0 if it is, else at -π."},
    {8004, error, malformed, "view-nodes", "The stored views are in [0, 1] and strictly increasing."},
    {8005, error, malformed, "diffuse-share", "`diffuse_share` is in [0, 1)."},
    {8006, error, malformed, "brdf-stored", "Each bin of a BRDF is stored: no root is FFFFFFFF."},

    {9001, error, malformed, "table-measure", "The axes of a table have linear measures."},
    {9002, error, malformed, "table-axes", "The indexed axes of a table come before the sampled ones."},
    {9003, error, malformed, "table-bins",
     "A table has as many bins as the product of the resolutions of its indexed axes."},
    {9004, error, malformed, "table-steps",
     "The ends of a table's axis are at most 2^100 in magnitude; a step of it is at least 2^-100, and at least "
     "2^-40 of the larger end."},
    {9005, error, malformed, "table-shares",
     "The shares of a table's bins, added up in their order, differ from 1 by no more than 2^-20."},
    {9006, error, malformed, "table-weights", "The `channels` of a table are 0 and its channel weights 1, 0, 0."},
};
const std::size_t rule_count = sizeof rules / sizeof rules[0];

const Rule* find_rule(int number) noexcept {
    for (const Rule& rule : rules)
        if (rule.number == number) return &rule;
    return nullptr;
}

} // namespace acdf
