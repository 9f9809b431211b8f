#include "build/builder/fast_rebuild.h"

#include "build/builder/options.h"
#include "build/builder/pixels.h"
#include "build/builder/sources.h"
#include "build/errors.h"
#include "build/probe/bad_texels.h"
#include "compress/halvings/code_bits.h"
#include "compress/moving/light.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

namespace acdf::builder {
namespace {

using compress::TreeSize;

compress::Description describe(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& given,
                               Projection projection) {
    const build::EnvironmentOptions options = internal(given);
    compress::Description out = compress::environment_description(
        width, height, projection == Projection::octahedral ? ACDF_PARAM_OCTAHEDRAL : ACDF_PARAM_LATLONG);
    out.filter = options.target.filter;
    out.channels = options.target.channels;
    const compress::ChannelWeights& weights = options.target.weights;
    out.channel_weights[0] = weights.r, out.channel_weights[1] = weights.g, out.channel_weights[2] = weights.b;
    const std::string& shown = given.source.projection;
    out.metadata = {
        {"tool", "acdf " ACDF_VERSION},
        {"fit.options", build::option_text(given.source.reading + wrap_text(repeats(given.target)), options)},
        {"fit.quality", "fast"},
        {"source.name", given.source.name},
        {"source.sha256", given.source.sha256},
        {"source.projection", shown.empty() ? name_of(projection) : shown}};
    return out;
}

std::vector<TreeSize> sizes_for(const Goal& goal, const compress::Description& description, std::uint64_t texels) {
    const auto leaves = [&](std::uint64_t wanted) { return static_cast<std::size_t>(std::min(wanted, texels)); };
    if (goal.kind == Goal::Kind::cells) return {{compress::kUsualCodeBits, leaves(goal.cells)}};
    const std::uint64_t room = compress::halvings_room(description, goal.budget);
    std::vector<TreeSize> out = compress::sizes_within(room, {8, 9, 10, 12});
    for (TreeSize& size : out) size.leaves = leaves(size.leaves);
    if (out.empty())
        throw std::runtime_error("a size of " + std::to_string(goal.budget) + " bytes is out of reach");
    return out;
}

compress::MovingShape shape_of(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& options,
                               Projection projection) {
    compress::MovingShape out;
    out.columns = width;
    out.rows = height;
    out.parameterization = projection == Projection::octahedral ? ACDF_PARAM_OCTAHEDRAL : ACDF_PARAM_LATLONG;
    out.planes = compress::planes_of(internal(options.target));
    out.bilinear = options.target.filter == ACDF_FILTER_BILINEAR;
    out.repeats = repeats(options.target) && projection == Projection::latlong;
    return out;
}

} // namespace

// At least what the reader takes for an open file beside its nodes and its lookups.
constexpr std::size_t kOpenFile = 4096;

void open(Frame& frame, const AcdfAllocator& allocator) {
    LoadOptions options;
    options.allocator = allocator;
    if (const acdf::Status status = File::from_memory(frame.bytes.data(), frame.bytes.size(), frame.file, options);
        !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
}

void require_fast(const EnvironmentOptions& options, Projection projection) {
    require(options.fit.fit == ACDF_FIT_VARIANCE && options.fit.max_weight == 0.0,
            "quality fast makes the variance fit without max_weight; choose quality best");
    require(options.goal.kind != Goal::Kind::variance,
            "quality fast has no goal of variance; give a budget or cells, or choose quality best");
    require(options.mis.kind == ACDF_PARTNER_NONE && options.codec == ACDF_CODEC_NONE,
            "quality fast makes uncompressed files without an MIS partner; choose quality best");
    const Domain own = projection == Projection::octahedral ? Domain::octahedral : Domain::latlong;
    require(options.target.domain == Domain::source || options.target.domain == own,
            "quality fast fits maps on their own grid; choose quality best");
    require(options.target.bad_texels != BadTexelPolicy::clamp,
            "quality fast reads pixels once, and clamp needs them twice; choose zero or error, or quality best");
}

FastRebuild::FastRebuild(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& options,
                         Projection projection)
    : target_(internal(options.target)), refuse_bad_(options.target.bad_texels == BadTexelPolicy::error),
      uniform_if_black_(options.target.uniform_if_black), cells_(options.goal.kind == Goal::Kind::cells),
      description_(describe(width, height, options, projection)),
      sizes_(sizes_for(options.goal, description_, std::uint64_t{width} * height)),
      sums_(shape_of(width, height, options, projection)), growth_(sizes_),
      coder_({1, 0}), // columns are axis 0 of the file
      bad_(std::size_t{width} * height), bad_of_row_(height),
      described_(compress::description_payload(description_)),
      metadata_(compress::metadata_payload(description_.metadata)) {
    const std::size_t leaves = sizes_.back().leaves;
    growth_.reserve();
    coder_.reserve(leaves);
    chunk_.reserve(compress::halvings_bytes(leaves, compress::kAxisBits, compress::kMostCodeBits) + 8);
}

void FastRebuild::reserve(Frame& frame) const {
    const std::size_t leaves = sizes_.back().leaves, squares = std::min<std::size_t>(leaves, 1 << 14);
    const std::size_t nodes = sizeof(AcdfHalving) * leaves, line = ACDF_ALIGNMENT;
    frame.arena.reserve(kOpenFile);
    frame.arena.reserve(nodes + line);
    frame.arena.reserve(nodes + sizeof(AcdfHalvedTree) + sizeof(double) * (sums_.shape().rows + std::size_t{1}) +
                        2 * squares * (sizeof(AcdfStart) + sizeof(std::uint16_t)) + 8 * line);
    frame.bytes.reserve(described_.size() + metadata_.size() + 8 * line +
                        compress::halvings_bytes(leaves, compress::kAxisBits, compress::kMostCodeBits));
}

void FastRebuild::make(const Pixels& pixels, Region region, bool alone, Gate& gate, Frame& frame) {
    const compress::Loop loop(alone);
    if (!complete_) region = {0, 0, sums_.shape().columns, sums_.shape().rows};
    const bool all = !complete_;
    complete_ = false;
    read(pixels, region, loop, gate);
    if (all) sums_.make_all(loop);
    else sums_.make(loop, region.y, region.y + region.height);
    complete_ = true;
    gate.tell(0.6, "fitting");
    frame.bad = bad();
    if (refuse_bad_ && frame.bad.count() > 0)
        throw std::invalid_argument("it has " + build::text(frame.bad) +
                                    "; repair them, or choose to zero or clamp them");
    if (sums_.largest() > std::numeric_limits<float>::max())
        throw std::invalid_argument(
            "the channels of the radiance add up to more than a float holds; scale it down");
    frame.file = File();
    store(fitted(loop, gate, frame), frame);
    open(frame, frame.arena.allocator());
}

void FastRebuild::read(const Pixels& pixels, const Region& region, const compress::Loop& loop, Gate& gate) {
    const std::uint32_t band = std::clamp((1u << 19) / std::max(region.width, 1u), 1u, 4096u);
    for (std::uint32_t first = 0; first < region.height; first += band) {
        const std::uint32_t count = std::min(band, region.height - first);
        loop.run(count, 1 + (1u << 14) / std::max(region.width, 1u),
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t y = begin; y < end; ++y)
                         read_row(pixels, region, region.y + first + static_cast<std::uint32_t>(y));
                 });
        gate.tell(0.4 * (first + count) / region.height, "reading pixels");
    }
}

void FastRebuild::read_row(const Pixels& pixels, const Region& region, std::uint32_t y) {
    float rgb[3 * compress::kTexelsAtOnce];
    const std::size_t width = sums_.shape().columns;
    std::uint8_t* bad = bad_.data() + y * width;
    if (bad_of_row_[y]) std::fill_n(bad + region.x, region.width, std::uint8_t{0});
    for (std::uint32_t x = region.x, end = region.x + region.width; x < end;) {
        const auto count = std::min<std::uint32_t>(end - x, compress::kTexelsAtOnce);
        const float* texels = packed_texels(pixels, x, y);
        if (!texels) {
            read_texels(pixels, x, y, count, rgb);
            texels = rgb;
        }
        if (compress::take_light(texels, x, y, count, target_, sums_, bad + x)) bad_of_row_[y] = 1;
        x += count;
    }
    if (bad_of_row_[y]) bad_of_row_[y] = std::any_of(bad, bad + width, [](std::uint8_t kind) { return kind != 0; });
    sums_.take_row(y);
}

BadTexels FastRebuild::bad() const {
    BadTexels out;
    const std::size_t width = sums_.shape().columns;
    for (std::size_t y = 0; y < bad_of_row_.size(); ++y) {
        if (!bad_of_row_[y]) continue;
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint8_t kind = bad_[y * width + x];
            if (kind == 0) continue;
            if (out.count() == 0) out.x = static_cast<int>(x), out.y = static_cast<int>(y);
            ++(kind == 1 ? out.nan : kind == 2 ? out.infinite : out.negative);
        }
    }
    return out;
}

const compress::Halvings& FastRebuild::fitted(const compress::Loop& loop, Gate& gate, Frame& frame) {
    if (!(sums_.largest() > 0.0f)) return even_light(frame);
    description_.total = sums_.total();
    growth_.run(sums_, loop, [&gate](double share) { gate.tell(0.6 + 0.3 * share, "fitting"); });
    const compress::Halvings& tree = coder_.code(sums_, growth_, growth_.leaves(), code_bits());
    frame.relative_variance = coder_.relative_variance();
    return tree;
}

/// Of as many cells as were asked for: more bits where rounding would count.
std::uint32_t FastRebuild::code_bits() const {
    const std::size_t leaves = growth_.leaves();
    return cells_ ? compress::enough_code_bits(leaves, sums_.variance(growth_.cost(leaves))) : growth_.code_bits();
}

const compress::Halvings& FastRebuild::even_light(Frame& frame) {
    if (!uniform_if_black_)
        throw build::NoEnergy("the map is black in the channels asked for, so there is nothing to sample");
    const compress::ChannelWeights& w = target_.weights;
    const double sum = target_.channels == ACDF_CHANNELS_LARGEST ? 1.0 : w.r + w.g + w.b;
    description_.total = 4.0 * ACDF_PI * sum * double{std::numeric_limits<float>::min()};
    frame.relative_variance = 0.0;
    return coder_.leaf();
}

void FastRebuild::store(const compress::Halvings& tree, Frame& frame) {
    compress::halvings_chunk(tree, chunk_);
    std::memcpy(described_.data() + offsetof(AcdfDescription, total), &description_.total,
                sizeof description_.total);
    const auto view = [](std::uint32_t type, std::uint32_t flags, const std::vector<std::uint8_t>& of) {
        return compress::ChunkView{type, flags, ACDF_CODEC_NONE, of.size(), of.data(), of.size()};
    };
    const compress::ChunkView chunks[] = {view(ACDF_CHUNK_DESCRIPTION, ACDF_CHUNK_FLAG_CRITICAL, described_),
                                          view(ACDF_CHUNK_HALVINGS, ACDF_CHUNK_FLAG_CRITICAL, chunk_),
                                          view(ACDF_CHUNK_METADATA, 0, metadata_)};
    frame.bytes.resize(compress::assembled_bytes(chunks, std::size(chunks)));
    compress::assemble(ACDF_KIND_ENVIRONMENT, chunks, std::size(chunks), frame.bytes.data());
}

} // namespace acdf::builder
