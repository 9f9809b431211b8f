// What the reader checks of a file, once: `File` stops at the first error, `acdf validate` reports all. Libraries
// beside the reader check what they alone read, as IndexedEnvironment::open and VisibleLocalView::of do.
#pragma once

#include "sources.h"

#include <acdf/halvings.h>
#include <acdf/reader.h>

#include <cstring>
#include <type_traits>

namespace acdf {

/// What opening returns where a rule is broken; ACDF_OK for rules of which only a warning is reported: such a file
/// is read.
ACDF_ONCE AcdfErrorCode code_of(int rule) noexcept;

/// A broken rule.
struct Finding {
    int number = 0; ///< of the rule
    u64 offset = 0; ///< byte in the file; for a compressed chunk that of its first stored byte
#ifndef ACDF_ENVIRONMENT_ONLY
    const char* detail = ""; ///< what was found and, if it helps, what to do; valid during the call
#endif
};

/// Called for each finding; returns false to stop.
using FindingSink = bool (*)(const Finding& finding, void* context);

struct Verdict {
    u64 errors = 0, warnings = 0;
    bool valid() const noexcept { return errors == 0; }
};

#ifndef ACDF_ENVIRONMENT_ONLY
/// Reports every finding that the checks can go on to, in the order of the rules' ranges. Any bytes, at any
/// alignment; reads nothing outside them; linear in the size and in what the compressed chunks inflate to.
Verdict validate(const void* bytes, std::size_t size, FindingSink sink, void* context,
                 const LoadOptions& options = {}) noexcept;

/// The same with any callable `sink(const Finding&)` that returns void, or bool (false: stop).
template <class Sink>
Verdict validate(const void* bytes, std::size_t size, Sink&& sink, const LoadOptions& options = {}) {
    using Target = std::remove_reference_t<Sink>;
    return validate(
        bytes, size,
        [](const Finding& finding, void* context) -> bool {
            Target& target = *static_cast<Target*>(context);
            if constexpr (std::is_same_v<decltype(target(finding)), void>) return target(finding), true;
            else return target(finding);
        },
        const_cast<void*>(static_cast<const void*>(&sink)), options);
}
#endif

/// A length in META, at any alignment.
inline u32 load_u32(const u8* bytes) noexcept {
    u32 value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// The bytes of one chunk, inflated if they were compressed. `data` is null where they cannot be read.
struct Payload {
    const u8* data = nullptr;
    u64 size = 0;
    u64 file_offset = 0;
    bool inflated = false;

    /// The byte of the file that stands for byte `position` of the payload.
    u64 at(u64 position) const noexcept { return inflated ? file_offset : file_offset + position; }
};

enum KnownChunk {
    chunk_description,
    chunk_bins,
    chunk_tree,
    chunk_metadata,
    chunk_local,
    chunk_views,
    chunk_partner,
    chunk_visibility,
    chunk_portals,
    chunk_halvings,
    chunk_maps,
    chunk_normals,
    known_chunks
};

struct Payloads {
    Payload of[known_chunks];
};

/// What an open file has of its bytes.
struct Contents {
    Payloads payloads;
    const AcdfDescription* description = nullptr;
    const AcdfAxis* axes = nullptr;       ///< description->axis_count
    const AcdfBin* bins = nullptr;        ///< description->bin_count; null: none
    const AcdfPartner* partner = nullptr; ///< null where the file is to be used alone
    const u8* metadata = nullptr;         ///< the payload of META after its count; null where absent
    u32 metadata_count = 0;
};

/// Where the parts of a file lie once found. Owns the nodes of halvings.
struct Parts : Contents {
    Parts() = default;
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;
    ~Parts();

    AcdfHalving* halvings = nullptr; ///< nodes of chunk HALV
    AcdfBlock halvings_block = {};   ///< that holds them, of `allocator`
    AcdfAllocator allocator = {};
    u32 halving_count = 0;
    AcdfBlock inflated = {}; ///< of the inflated chunks, from take_block; the caller gives it back

#ifndef ACDF_ENVIRONMENT_ONLY
    const AcdfViews* views = nullptr;           ///< of a BRDF
    const float* nodes = nullptr;               ///< views->theta_count
    const AcdfLocalHeader* local = nullptr;     ///< of local environments
    const AcdfNormalsHeader* normals = nullptr; ///< of a local environment on one tree of halvings
    const u8* normal_splits = nullptr;          ///< a bit for each halving; then the codes of each row,
    u64 normals_size = 0;                       ///< of so many bytes
#endif
};

/// The checks themselves, on bytes aligned to 8. `parts` is complete where the verdict has no errors.
ACDF_ONCE Verdict check(const u8* bytes, u64 size, const LoadOptions& options, FindingSink sink, void* context,
                        Parts& parts) noexcept;

} // namespace acdf
