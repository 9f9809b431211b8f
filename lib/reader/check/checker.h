// Inside the checks: what check*.cpp share. Not installed.
#pragma once

#include "check/check.h"

namespace acdf {

/// Collects findings: counts them, passes them to the sink, and falls silent once the sink says stop.
class Report {
public:
    Report(FindingSink sink, void* context) noexcept : sink_(sink), context_(context) {}

#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    void
    add(int rule, std::uint64_t offset, const char* format, ...) noexcept;

    bool stopped() const noexcept { return stopped_; }
    const Verdict& verdict() const noexcept { return verdict_; }

private:
    FindingSink sink_;
    void* context_;
    Verdict verdict_;
    bool stopped_ = false;
};

/// The bytes of one chunk, inflated if they were compressed. `data` is null where they cannot be read.
struct Payload {
    const std::uint8_t* data = nullptr;
    std::uint64_t size = 0;
    std::uint64_t file_offset = 0;
    bool inflated = false;

    /// The byte of the file that stands for byte `position` of the payload.
    std::uint64_t at(std::uint64_t position) const noexcept {
        return inflated ? file_offset : file_offset + position;
    }
};

enum KnownChunk {
    chunk_description,
    chunk_bins,
    chunk_tree,
    chunk_metadata,
    chunk_tiles,
    chunk_rows,
    chunk_local,
    chunk_views,
    chunk_partner,
    chunk_visibility,
    chunk_portals,
    chunk_sums,
    chunk_grid,
    chunk_halvings,
    known_chunks
};

/// Positions on the first two axes.
struct TileBox {
    std::uint32_t low[2], high[2];
};

/// The boxes of all tiles; `of` is null where there are none. Frees them.
struct TileBoxes {
    TileBox* of = nullptr;
    bool given = false; ///< there is a TILE, right or wrong
    bool fast = false;  ///< of the fast shape: roots are no offsets in TREE
    Payload roots;      ///< the part of TILE that tells the roots of tiles

    TileBoxes() = default;
    TileBoxes(const TileBoxes&) = delete;
    TileBoxes& operator=(const TileBoxes&) = delete;
    ~TileBoxes();
};

struct Payloads {
    Payload of[known_chunks];
};

inline std::uint64_t round_up(std::uint64_t n, std::uint64_t to) noexcept { return (n + to - 1) / to * to; }

/// DESC. Sets parts.description and parts.axes if its length is right.
void check_description(const Payload& payload, std::uint32_t kind, Report& report, Parts& parts) noexcept;
/// META. Sets parts.metadata if it is well-formed.
void check_metadata(const Payload& payload, Report& report, Parts& parts) noexcept;
/// TILE and ROWS; needs parts.description. Sets parts.tiles and what belongs to it, and `boxes`, if they are right.
/// `fast`: there are no ROWS, and roots are no offsets in TREE (check_fast).
void check_tiles(const Payload& tiles, const Payload& rows, bool fast, Report& report, Parts& parts,
                 TileBoxes& boxes) noexcept;
/// SUMS and GRID, which come beside TILE; needs what check_tiles sets. Sets parts.fast if they are right.
void check_fast(const Payloads& payloads, const TileBoxes& boxes, Report& report, Parts& parts) noexcept;
/// BINS and TREE; needs parts.description and, where there are tiles, those. Sets parts.bins, parts.tree.
void check_tree(const Payload& bins, const Payload& tree, std::uint32_t kind, const TileBoxes& boxes,
                Report& report, Parts& parts) noexcept;
/// HALV; needs parts.description. Sets parts.halvings.
void check_halvings(const Payload& payload, Report& report, const AcdfAllocator& allocator, Parts& parts) noexcept;
/// What the kind asks of axes and bins; needs parts.description.
/// Axes 0 and 1 must be those of an environment.
void check_environment_axes(const Payload& payload, Report& report, const Parts& parts) noexcept;
void check_environment(const Payload& description, const Payload& bins, Report& report,
                       const Parts& parts) noexcept;
/// The same of local environments, and LOCL. Sets parts.local and parts.lights.
void check_local_kind(const Payload& description, const Payload& local, const TileBoxes& boxes, Report& report,
                      Parts& parts) noexcept;
/// PLAC of a local environment; needs what check_local_kind sets. Sets parts.visibility if it is right.
void check_visibility(const Payload& payload, Report& report, Parts& parts) noexcept;
/// PORT of a local environment; needs what check_visibility sets. Sets parts.portals if it is right.
void check_portals(const Payload& payload, Report& report, Parts& parts) noexcept;
/// The same of BRDFs, and VIEW. Sets parts.views and parts.nodes.
void check_brdf_kind(const Payload& description, const Payload& views, Report& report, Parts& parts) noexcept;
/// COMP, where there is one; needs parts.description. Sets parts.partner.
void check_partner(const Payload& payload, std::uint32_t kind, Report& report, Parts& parts) noexcept;
void check_table_kind(const Payload& description, const Payload& bins, Report& report, const Parts& parts) noexcept;

} // namespace acdf
