#include "rules/rules.h"

#include <algorithm>

namespace acdf {

namespace {
constexpr Severity error = Severity::error;
constexpr Severity warning = Severity::warning;
} // namespace

// Ascending by number. SPEC.md has the same sentences, section by section; a test compares the two.
const Rule rules[] = {
    {1001, error, "open", "The file can be opened for reading."},
    {1002, error, "read", "The file is a regular file and all its bytes can be read."},
    {1003, error, "memory", "There is memory for the file, its inflated chunks and the checks."},
    {1004, error, "file-limit", "The file is no larger than the reader's limit."},

    {2001, error, "header-size", "The file holds a whole header of 64 bytes."},
    {2002, error, "magic", "The file starts with the 12 bytes of the magic."},
    {2003, error, "version", "The major version is 1."},
    {2004, error, "header-crc", "`header_crc` is the CRC-32 of bytes 0 to 59 and of the chunk table."},
    {2005, error, "file-length", "`file_length` is the size of the file."},
    {2006, error, "kind", "`kind` is one of those of §2.1."},
    {2007, error, "required-feature", "No bit of `required_features` is set."},
    {2008, error, "header-reserved", "The reserved bytes of the header are zero."},

    {3001, error, "chunk-count", "There are 1 to 64 chunks and the file holds their whole table."},
    {3002, error, "critical-chunk", "A critical chunk is of a known type."},
    {3003, error, "duplicate-chunk", "No two chunks are of one type."},
    {3004, error, "missing-chunk",
     "DESC is there, and BINS and TREE are unless HALV is; in kinds 4 and 5 HALV is, with BINS or MAPS; beside "
     "HALV "
     "in kinds 2 and 3 BINS and NORM are."},
    {3005, error, "codec", "`codec` is 0 (none), 1 (zlib) or, of TREE, 2 (planes)."},
    {3006, error, "chunk-offset",
     "A payload starts at the first multiple of 64 after what comes before it, in the table's order."},
    {3007, error, "chunk-bounds", "A payload lies inside the file."},
    {3008, error, "file-end", "`file_length` is the end of the last payload, rounded up to 64."},
    {3009, error, "chunk-flags",
     "`flags` of a known type are those of §3, of others at most 1; `reserved` is zero."},
    {3010, error, "raw-length", "With codec 0, `raw_length` equals `stored_length`."},
    {3011, error, "deflate-ratio", "With codec 1 or 2, `raw_length` is less than 1032 (`stored_length` + 1)."},
    {3012, error, "inflate-limit",
     "The compressed chunks, but for unknown ones, inflate to no more than the reader's limit."},
    {3013, error, "chunk-kind", "A chunk comes only in files of the kinds that §3 lists."},
    {3014, error, "chunk-type", "The type of a chunk is four printable ASCII characters."},

    {4001, error, "chunk-crc", "`crc` is the CRC-32 of the stored bytes."},
    {4002, error, "padding", "The bytes between payloads and after the last one are zero."},
    {4003, error, "zlib-stream", "With codec 1, the stored bytes are one whole zlib stream of `raw_length` bytes."},
    {4004, error, "payload-length",
     "DESC is 64 + 48 `axis_count` bytes long and BINS is 8 `bin_count` bytes long."},
    {4005, error, "planes",
     "With codec 2, the stored bytes are one whole zlib stream of the planes of a tree of `raw_length` bytes."},

    {5001, error, "parameterization", "`parameterization` is one of those of §5.1."},
    {5002, error, "fit", "`fit` is one of those of §5.1."},
    {5003, error, "filter", "`filter` is one of those of §5.1."},
    {5004, error, "up-axis", "`up_axis` is 2 (z)."},
    {5005, error, "handedness", "`handedness` is 0 (right-handed)."},
    {5006, error, "axis-count", "`axis_count` is 1 to 8."},
    {5007, error, "bin-count", "`bin_count` is at least 1."},
    {5008, error, "description-reserved", "The reserved fields of DESC are zero."},
    {5009, error, "channel-weights", "The channel weights are finite and not negative."},
    {5010, error, "total", "`total` is finite and positive."},
    {5011, error, "axis-name",
     "The name of an axis is UTF-8, not empty, padded with zero bytes, and no other axis has it."},
    {5012, error, "axis-role", "`role` is 0 (sampled) or 1 (indexed), and one axis at least is sampled."},
    {5013, error, "axis-measure", "`measure` is 0, 1 or 2."},
    {5014, error, "axis-resolution", "`resolution` is 1 to 2147483647."},
    {5015, error, "axis-range", "`low` and `high` are finite and differ."},
    {5016, error, "parameterization-kind", "The parameterization is that of the kind."},
    {5017, error, "metadata",
     "META is as §5.3 says: lengths within the chunk, nothing left over, at most 1024 pairs, keys of 1 to 255 "
     "bytes, all UTF-8."},
    {5018, error, "duplicate-key", "No two metadata keys are equal."},
    {5019, error, "channels", "`channels` is one of those of §5.1."},
    {5020, error, "partner",
     "COMP has a record for each bin or, but for local environments, none; `reserved` is zero, `share` in (0, 1), "
     "recommended shares in (0, 1], fluxes finite, not negative, and 0 but in local environments."},
    {5021, error, "partner-kind",
     "`kind` and `heuristic` of COMP are those of §5.4; `kind` is 4 for tables alone."},

    {6001, error, "tree-length", "TREE is 1 to 4294967294 units of two bytes long."},
    {6002, error, "curve-end", "A curve ends inside TREE."},
    {6003, error, "curve-axis", "The axis of a curve is a sampled axis."},
    {6004, error, "curve-header",
     "The codes of cumulative values and of positions in a curve's header are 0, 1 or 2."},
    {6005, error, "curve-segments",
     "A curve has 1 to 1048575 segments; the long form of the count is for more than 63."},
    {6006, error, "knot-order", "The positions of a curve are strictly increasing."},
    {6007, error, "knot-range",
     "The positions of a curve lie strictly inside the range of its axis, on every path to the curve."},
    {6008, error, "cumulative-order", "The cumulative values of a curve never decrease."},
    {6009, error, "link", "A link leads to the start of a later curve."},
    {6010, error, "root", "The root of a bin that has a tree of its own is the start of a curve."},
    {6011, error, "curve-padding", "The padding inside and after a curve is zero."},
    {6012, warning, "unreachable-curve", "A curve is reached from a root (else its bytes are wasted)."},
    {6013, error, "tilt", "No tilt is -32768."},
    {6014, error, "tilt-split", "Below a segment of nonzero tilt no curve is on the same axis."},
    {6015, error, "dark-link", "A segment of probability 0 ends."},
    {6016, error, "depth", "A path from a root to a cell passes at most 64 curves."},
    {6017, error, "bin-share", "`share` is finite and not negative."},
    {6018, error, "curve-count", "TREE of n bytes holds at most n / 4 + 1 curves."},
    {6019, error, "relative-knots",
     "If the knots of a curve have one-byte positions, its range begins at the same position on every path to it."},
    {6026, error, "bin-row", "The row of a bin is one of NORM, or FFFFFFFF."},

    {6030, error, "halvings",
     "HALV is as long as its counts say, codes have 2 to 12 bits, and its reserved fields are zero."},
    {6031, error, "halved-nodes", "`halving_count` nodes of HALV are halved, and every half is there."},
    {6032, error, "halved-axis", "A node is halved on a sampled axis that it has two steps or more of."},
    {6033, error, "halved-numbers",
     "A dark node is a leaf; one with a code between the first and the last has two steps of random numbers or "
     "more on its axis."},
    {6034, error, "halvings-padding", "The padding of HALV is zero."},
    {6035, error, "halvings-alone", "HALV comes without TREE, without BINS but in kinds 2 to 4, and with fit 4."},
    {6036, error, "maps",
     "MAPS is as long as its counts say: as many maps as bins, at most as many splits as halvings, codes of 4 to "
     "12 "
     "bits, and `sun` at most 4."},
    {6037, error, "map-splits",
     "`split_count` halvings have a code of each map or row; all above such a halving have one, too."},
    {6038, error, "maps-padding", "The padding of MAPS and of NORM is zero."},
    {6039, error, "normals",
     "NORM is as long as its codes need, with 1 to as many rows as bins, at most as many splits as halvings, "
     "`row_count` times `split_count` at most 64 times its bytes, codes of 4 to 8 bits, and `reserved` is zero."},
    {6040, error, "normal-codes",
     "NORM has all codes of each row; where one lies between the first and the last, two steps or more are "
     "divided."},

    {7001, error, "environment-axes",
     "The first axes of an environment, local or not, are those of §6.1 or, with parameterization 4, §6.6, of at "
     "most 65536 steps; one that is not local has no others."},
    {7002, error, "environment-bins", "An environment has one bin."},
    {7003, error, "normal-axes",
     "A local environment has the axes of an environment, and one or two of normals as in §10; beside NORM one."},
    {7004, error, "normal-bins", "A local environment has as many bins as its normals' axes make."},
    {7005, error, "local-chunk",
     "A local environment has LOCL, 8 bytes long; `cosine_share` is in [0, 1), and `reserved` is zero."},
    {7008, error, "environment-share", "The share of an environment's bin is 1."},
    {7009, error, "visibility", "PLAC comes with NORM and is as long as its counts say, with at least one row."},
    {7010, error, "visibility-bounds",
     "The bounds of visibility cells are finite and rise, and the transform is finite."},
    {7011, error, "visibility-splits",
     "Splits of visibility cells stand in preorder, at most 64 on a path, each met once, and lead to rows that are "
     "there."},
    {7012, error, "visibility-split", "A split of visibility cells is on one of axes 0 to 5, its position finite."},
    {7013, error, "visibility-columns",
     "The columns of each set of visibility cells stand in preorder, at most 64 on a path, each met once, and part "
     "tiles that are there."},
    {7014, error, "visibility-odds", "No odds of a cell are 0 or 255: no part of the light has none."},
    {7015, error, "visibility-sets", "The set of columns that a row of visibility cells names is there."},
    {7016, error, "portals",
     "PORT comes with PLAC and is as long as its counts say: 1 to 8 portals, 1 to as many maps, of 1 to 4096 "
     "cells "
     "along each axis, and 1 to 4 pieces along each side."},
    {7017, error, "portal",
     "The corner of a portal is finite, its sides are positive and finite, and its map is there."},
    {7018, error, "portal-map",
     "The axes of a map of portals are unit and at right angles; its unit is positive and finite."},
    {7019, error, "portal-sums",
     "The sums of a map begin with a row and a column of 0, and no cell between them has less than 0."},
    {7020, error, "indexed-axes",
     "An indexed environment has the two axes of an environment first, then one to three linear indexed axes of 2 "
     "to 65536 steps, and as many bins as their product."},
    {7021, error, "coordinates",
     "The coordinates of an indexed axis are finite and rise strictly from its `low` to its `high`."},
    {7022, error, "map",
     "The shares of maps are positive and add up to 1 within 2^-20; `sun_share` is in [0, 1), and 0 where `sun` or "
     "`radius` is 0; `radius` is 0 or in [2^-10, 1]; the direction of a sun is unit where it has a radius, and "
     "else 0."},

    {8001, error, "brdf-axes",
     "A BRDF has the axes of §11, cos_theta_h without HALV of at most 268435456 steps and the others of at most "
     "65536."},
    {8002, error, "brdf-bins", "A BRDF has as many bins as the product of its axes of views."},
    {8003, error, "views",
     "VIEW is there, as long as `theta_count` says, with the counts of the axes; only flag bit 0 may be set, where "
     "`phi_count` is 1, and phi_h begins at 0 if it is, else at -π."},
    {8004, error, "view-nodes", "The stored views are in [0, 1] and strictly increasing."},
    {8005, error, "diffuse-share", "`diffuse_share` is in [0, 1)."},
    {8006, error, "brdf-stored", "Each bin of a BRDF is stored: no root is FFFFFFFF."},

    {9001, error, "table-measure", "The axes of a table have linear measures."},
    {9002, error, "table-axes", "The indexed axes of a table come before the sampled ones."},
    {9003, error, "table-bins", "A table has as many bins as the product of the resolutions of its indexed axes."},
    {9004, error, "table-steps",
     "The ends of a table's axis are at most 2^100 in magnitude; a step of it is at least 2^-100, and at least "
     "2^-40 of the larger end."},
    {9005, error, "table-shares",
     "The shares of a table's bins, added up in their order, differ from 1 by no more than 2^-20."},
    {9006, error, "table-weights", "The `channels` of a table are 0 and its channel weights 1, 0, 0."},
    {9007, error, "table-roots",
     "A table's `root` is how many nodes are halved before its tree, FFFFFFFF where that is a leaf or there is "
     "none."},
};
const std::size_t rule_count = sizeof rules / sizeof rules[0];

const Rule* find_rule(int number) noexcept {
    const Rule* const end = rules + rule_count;
    const Rule* const found =
        std::lower_bound(rules, end, number, [](const Rule& rule, int sought) { return rule.number < sought; });
    return found != end && found->number == number ? found : nullptr;
}

} // namespace acdf
