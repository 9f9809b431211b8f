// Visibility cells from a renderer's own rays: the public object.
#include <acdf/learn.h>

#include "build/builder/guard.h"
#include "compress/store/store.h"
#include "compress/visibility/counts.h"
#include "compress/visibility/learned_cells.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::builder {

/// Bytes, and the file that reads them in place.
struct LearnedFile {
    std::vector<std::uint8_t> bytes;
    File file;
};

namespace {

constexpr std::size_t kSlots = std::size_t{1} << 20; ///< 28 MiB; cells that are found take about as much
/// Columns, which all cells share, are so many times the root of the bytes of cells.
constexpr double kColumns = 0.3;
constexpr double kMostColumns = (1u << compress::VisibilityCounts::part_bits) - 1;

std::shared_ptr<const LearnedFile> opened(std::vector<std::uint8_t> bytes) {
    auto out = std::make_shared<LearnedFile>();
    out->bytes = std::move(bytes);
    if (const acdf::Status status = File::from_memory(out->bytes.data(), out->bytes.size(), out->file);
        !status.ok())
        throw std::invalid_argument(status.message);
    return out;
}

/// A file with other visibility cells, without portals.
std::vector<std::uint8_t> with_cells(const std::vector<std::uint8_t>& bytes, const compress::Chunk& cells) {
    AcdfHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    std::vector<compress::ChunkView> chunks;
    const auto add_cells = [&] {
        chunks.push_back(
            {cells.type, 0, ACDF_CODEC_NONE, cells.bytes.size(), cells.bytes.data(), cells.bytes.size()});
    };
    bool added = false;
    for (std::uint32_t i = 0; i < header.chunk_count; ++i) {
        AcdfChunk chunk;
        std::memcpy(&chunk, bytes.data() + sizeof header + i * sizeof chunk, sizeof chunk);
        if (chunk.type == ACDF_CHUNK_VISIBILITY || chunk.type == ACDF_CHUNK_PORTALS) continue;
        if (chunk.type == ACDF_CHUNK_METADATA && !added) add_cells(), added = true;
        chunks.push_back({chunk.type, chunk.flags, chunk.codec, chunk.raw_length, bytes.data() + chunk.offset,
                          static_cast<std::size_t>(chunk.stored_length)});
    }
    if (!added) add_cells();
    std::vector<std::uint8_t> out(compress::assembled_bytes(chunks.data(), chunks.size()));
    compress::assemble(static_cast<AcdfKind>(header.kind), chunks.data(), chunks.size(), out.data());
    return out;
}

std::array<float, 3> array_of(const float v[3]) { return {v[0], v[1], v[2]}; }

} // namespace

struct LearnedVisibility::Data {
    std::shared_ptr<const LearnedFile> given; ///< whose light it is
    AcdfLocal local{};
    LearnOptions options;
    std::optional<compress::VisibilityParts> parts;
    std::optional<compress::VisibilityCounts> counts;
    std::shared_ptr<const LearnedFile> last; ///< by atomic loads and stores
};

LearnedVisibility::LearnedVisibility() noexcept = default;
LearnedVisibility::~LearnedVisibility() = default;
LearnedVisibility::LearnedVisibility(LearnedVisibility&&) noexcept = default;
LearnedVisibility& LearnedVisibility::operator=(LearnedVisibility&&) noexcept = default;

Status LearnedVisibility::make(const void* file, std::size_t size, const LearnOptions& options,
                               LearnedVisibility& result) noexcept {
    result = {};
    static const Control silent;
    return guarded(
        silent,
        [&](Gate&) {
            float longest = 0.0f;
            std::array<float, 3> low = array_of(options.low), high = array_of(options.high);
            for (std::size_t k = 0; k < 3; ++k) {
                require(std::fabs(options.low[k]) <= 1e30f && std::fabs(options.high[k]) <= 1e30f,
                        "low and high are beyond 1e30, or no numbers");
                require(options.low[k] <= options.high[k], "low is above high");
                longest = std::max(longest, high[k] - low[k]);
                if (low[k] < high[k]) continue; // a floor: the file's box has a volume
                low[k] = std::nextafter(low[k], -1e38f);
                high[k] = std::nextafter(high[k], 1e38f);
            }
            require(longest >= 1e-30f, "the box from low to high is a point");
            require(file != nullptr, "there is no file");
            auto data = std::make_unique<Data>();
            const auto* first = static_cast<const std::uint8_t*>(file);
            data->given = opened(std::vector<std::uint8_t>(first, first + size));
            const File& given = data->given->file;
            if (given.kind() != ACDF_KIND_LOCAL) throw std::invalid_argument("a file of acdf local is needed");
            data->local = given.local().data();
            if (!data->local.rows_of_normals)
                throw std::invalid_argument("visibility cells need a file of acdf local without --no-sharing");
            if (given.partner())
                throw std::invalid_argument("a file made for MIS has no light where its partner suffices; make it "
                                            "without --mis");
            data->options = options;
            data->parts.emplace(
                data->local, given.description().bin_count,
                static_cast<std::uint32_t>(std::min(kColumns * std::sqrt(double(options.bytes)), kMostColumns)));
            data->counts.emplace(low, high, kSlots);
            data->last = data->given;
            result.data_ = std::move(data);
        },
        [&]() noexcept { result = {}; });
}

void LearnedVisibility::add(const float position[3], const float normal[3], const float direction[3],
                            bool visible) noexcept {
    if (!(normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2] > 0.0f)) return;
    std::uint32_t part = 0;
    if (data_->parts->find(direction, part)) data_->counts->add(position, normal, part, visible);
}

Status LearnedVisibility::update(const Control& control) noexcept {
    return guarded(
        control,
        [&](Gate&) {
            require(data_ != nullptr, "it is empty; make it first");
            compress::LearnedSize size;
            size.bytes = data_->options.bytes;
            size.beside_cosine = data_->options.beside_cosine;
            const compress::Chunk cells =
                compress::learned_visibility(*data_->parts, data_->counts->sorted(), size);
            std::atomic_store(&data_->last, opened(with_cells(data_->given->bytes, cells)));
        },
        []() noexcept {});
}

std::shared_ptr<const File> LearnedVisibility::file() const noexcept {
    if (!data_) return nullptr;
    const std::shared_ptr<const LearnedFile> last = std::atomic_load(&data_->last);
    return {last, &last->file};
}

Status LearnedVisibility::save(const char* path) const noexcept {
    static const Control silent;
    return guarded(
        silent,
        [&](Gate&) {
            require(data_ != nullptr, "it is empty; make it first");
            const std::shared_ptr<const LearnedFile> last = std::atomic_load(&data_->last);
            const std::string whole = path, part = whole + ".part";
            std::FILE* out = std::fopen(part.c_str(), "wb");
            if (!out) throw std::invalid_argument(part + ": cannot be written");
            const bool written = std::fwrite(last->bytes.data(), 1, last->bytes.size(), out) == last->bytes.size();
            const bool closed = std::fclose(out) == 0;
            if (written && closed && std::rename(part.c_str(), whole.c_str()) == 0) return;
            std::remove(part.c_str());
            throw std::invalid_argument(whole + ": cannot be written");
        },
        []() noexcept {});
}

} // namespace acdf::builder
