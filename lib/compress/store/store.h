// From a cascade to the bytes of an .acdf file (format/SPEC.md).
#pragma once

#include "compress/cascade.h"
#include "compress/halvings/halvings.h"
#include "compress/partner.h"

#include <acdf/layout.h>

#include <string>
#include <utility>
#include <vector>

namespace acdf::compress {

using Metadata = std::vector<std::pair<std::string, std::string>>;

struct AxisDescription {
    std::string name; ///< UTF-8, at most 15 bytes
    AcdfAxisRole role = ACDF_AXIS_SAMPLED;
    AcdfAxisMeasure measure = ACDF_MEASURE_LINEAR;
    std::uint32_t resolution = 1;
    double low = 0.0, high = 1.0;
};

/// A chunk beside those that every file has: critical, but for PLAC and PORT, without which a reader serves normals
/// alone.
struct Chunk {
    std::uint32_t type = 0;
    std::vector<std::uint8_t> bytes;
};

/// What a file says of itself beside its curves.
struct Description {
    AcdfKind kind = ACDF_KIND_ENVIRONMENT;
    AcdfParameterization parameterization = ACDF_PARAM_LATLONG;
    AcdfFit fit = ACDF_FIT_VARIANCE;
    AcdfFilter filter = ACDF_FILTER_NEAREST;
    AcdfChannels channels = ACDF_CHANNELS_WEIGHTED;
    double channel_weights[3] = {0.2126, 0.7152, 0.0722};
    double total = 1.0;
    std::vector<AxisDescription> axes;
    std::vector<float> shares{1.0f}; ///< one a root: its integral over `total`
    std::vector<Chunk> chunks;       ///< what the kind needs beside the curves
    Metadata metadata;
};

/// An environment of columns x rows texels, lat-long or on the octahedral square.
Description environment_description(std::uint32_t columns, std::uint32_t rows,
                                    AcdfParameterization parameterization = ACDF_PARAM_LATLONG);

/// The bytes of chunk TREE, and the offset of each root in it, in units of two bytes.
struct EncodedTree {
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint32_t> roots;
};

/// Quantizes and packs the curves in the order given. Probabilities get the width at which bytes, at `price`
/// each, and what rounding adds to E[(f/p)^2] cost least together. Throws std::invalid_argument where the cascade
/// breaks a limit of the format.
EncodedTree encode_tree(const Cascade& cascade, double price = 1e-8);

/// Chunk LOCL.
Chunk local_chunk(float cosine_share);

/// Chunk COMP. `records`: none, or one a bin.
Chunk partner_chunk(const Partner& partner, float recommended_light_share,
                    const std::vector<AcdfPartnerRecord>& records);

/// The whole file. The same arguments give the same bytes. Metadata is never compressed: it is short, stays
/// readable, and keeps its size whatever numbers it holds.
std::vector<std::uint8_t> store(const EncodedTree& tree, const Description& description,
                                AcdfCodec codec = ACDF_CODEC_NONE);
/// The same of a tree of halvings.
std::vector<std::uint8_t> store(const Halvings& tree, const Description& description,
                                AcdfCodec codec = ACDF_CODEC_NONE);
/// The same of bins; `roots`: of each bin its row or, in tables, its first halving; or ACDF_NO_ROOT.
std::vector<std::uint8_t> store(const Halvings& tree, const std::vector<std::uint32_t>& roots,
                                const Description& description, AcdfCodec codec = ACDF_CODEC_NONE);
/// What chunks DESC and META hold.
std::vector<std::uint8_t> description_payload(const Description& description);
std::vector<std::uint8_t> metadata_payload(const Metadata& metadata);

/// A chunk as it is stored.
struct ChunkView {
    std::uint32_t type, flags, codec;
    std::uint64_t raw_length;
    const std::uint8_t* data;
    std::size_t size;
};

/// Bytes of a file of these chunks, and the file itself, in memory of so many bytes.
std::size_t assembled_bytes(const ChunkView* chunks, std::size_t count);
void assemble(AcdfKind kind, const ChunkView* chunks, std::size_t count, std::uint8_t* file);

/// How many bytes chunk HALV may have in an uncompressed file of `file_bytes`, of an environment or a table; 0:
/// none fits.
std::uint64_t halvings_room(const Description& description, std::uint64_t file_bytes);

} // namespace acdf::compress
