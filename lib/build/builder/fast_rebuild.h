// The part of EnvironmentRebuilder that takes memory once.
#pragma once

#include "build/builder/guard.h"
#include "compress/halvings/coder.h"
#include "compress/moving/sums.h"
#include "compress/store/store.h"

#include <acdf/builder.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::builder {

/// The memory of one open file, kept when the file is closed.
class Arena {
public:
    Arena() = default;
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    /// Room for a block of so many bytes.
    void reserve(std::size_t bytes) { grow(blocks_[count_++], bytes); }
    AcdfAllocator allocator() { return {take, give, this}; }

private:
    struct Block {
        std::unique_ptr<unsigned char[]> memory;
        unsigned char* data = nullptr;
        std::size_t bytes = 0;
        bool taken = false;
    };

    static void grow(Block& block, std::size_t bytes) {
        block.memory.reset(new unsigned char[bytes + ACDF_ALIGNMENT]);
        const auto address = reinterpret_cast<std::uintptr_t>(block.memory.get());
        block.data = block.memory.get() + (ACDF_ALIGNMENT - address % ACDF_ALIGNMENT) % ACDF_ALIGNMENT;
        block.bytes = bytes;
    }
    static void* take(void* context, std::size_t bytes, std::size_t) noexcept {
        auto& arena = *static_cast<Arena*>(context);
        for (Block& block : arena.blocks_)
            if (!block.taken && block.bytes >= bytes) {
                block.taken = true;
                return block.data;
            }
        return nullptr;
    }
    static void give(void* context, void* data, std::size_t) noexcept {
        for (Block& block : static_cast<Arena*>(context)->blocks_)
            if (block.data == data) block.taken = false;
    }

    std::array<Block, 3> blocks_;
    std::size_t count_ = 0;
};

/// What a frame makes.
struct Frame {
    Arena arena;
    std::vector<std::uint8_t> bytes;
    File file; // goes before the arena does
    double relative_variance = 0.0;
    BadTexels bad;
};

/// Makes the view of a frame's bytes.
void open(Frame& frame, const AcdfAllocator& allocator);

/// Throws build::OptionError for what quality fast does not make.
void require_fast(const EnvironmentOptions& options, Projection projection);

/// Quality fast: sums, growth, codes and the file's bytes, all in memory that is taken once.
class FastRebuild {
public:
    FastRebuild(std::uint32_t width, std::uint32_t height, const EnvironmentOptions& options,
                Projection projection);

    /// Takes the memory of a frame, before the first is made.
    void reserve(Frame& frame) const;
    /// All pixels are read next time.
    void forget() { complete_ = false; }
    /// Makes a frame of pixels of which only those of `region` are new. `alone`: by the calling thread.
    void make(const Pixels& pixels, Region region, bool alone, Gate& gate, Frame& frame);

private:
    void read(const Pixels& pixels, const Region& region, const compress::Loop& loop, Gate& gate);
    void read_row(const Pixels& pixels, const Region& region, std::uint32_t y);
    BadTexels bad() const;
    const compress::Halvings& fitted(const compress::Loop& loop, Gate& gate, Frame& frame);
    std::uint32_t code_bits() const;
    const compress::Halvings& even_light(Frame& frame);
    void store(const compress::Halvings& tree, Frame& frame);

    compress::TargetOptions target_;
    bool refuse_bad_, uniform_if_black_, cells_;
    compress::Description description_;
    std::vector<compress::TreeSize> sizes_;
    compress::MovingSums sums_;
    compress::HalvedGrowth growth_;
    compress::TreeCoder coder_;
    std::vector<std::uint8_t> bad_;        ///< a texel each: 1 NaN, 2 infinite, 3 negative
    std::vector<std::uint8_t> bad_of_row_; ///< whether a row has any
    std::vector<std::uint8_t> described_, metadata_, chunk_;
    bool complete_ = false; ///< whether the sums are those of the last frame
};

} // namespace acdf::builder
