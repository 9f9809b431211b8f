// What rays found, counted in a grid: by place, normal and part of the sphere.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace acdf::compress {

/// Of one part of the sphere, at one place and normal: how many rays there were, and how many met nothing.
struct VisibilityCount {
    std::uint64_t key = 0; ///< see VisibilityCounts
    std::uint32_t all = 0, seen = 0;
};

/// A hashed grid of fixed size, filled by many threads without locks. Where it would get too full, its cells become
/// twice as wide, which adds up counts and loses none: what it holds depends on the rays alone, not on their order
/// or on threads. A ray that meets such a moment waits for it.
class VisibilityCounts {
public:
    static constexpr std::uint32_t steps = 5;                   ///< of normals, along the sides of a cube
    static constexpr std::uint32_t normals = 6 * steps * steps; ///< an odd number of steps: axes are in the middle
    static constexpr std::uint32_t part_bits = 10, normal_bits = 8, axis_bits = 15;
    static_assert(normals <= 1u << normal_bits && part_bits + normal_bits + 3 * axis_bits < 64);

    /// All counts by rising key: those of a cell and a normal stand together. While it lives rays are counted, but
    /// for those that would make cells wider, which wait.
    class Sorted {
    public:
        std::size_t size() const { return counts_.size(); }
        const VisibilityCount& operator[](std::size_t i) const { return counts_[i]; }
        float width() const { return width_; }
        float low(std::size_t axis) const { return low_[axis]; }
        float high(std::size_t axis) const { return high_[axis]; }

    private:
        friend class VisibilityCounts;
        explicit Sorted(VisibilityCounts& of);
        std::unique_lock<std::mutex> lock_;
        const std::vector<VisibilityCount>& counts_;
        std::array<float, 3> low_, high_;
        float width_;
    };

    /// Rays from within the box count. `slots`: a power of two, so many that a single cell has room in three
    /// quarters of them; each takes 28 bytes, all of them from the start.
    VisibilityCounts(const std::array<float, 3>& low, const std::array<float, 3>& high, std::size_t slots);

    /// One ray to a part. Returns false, and counts nothing, where the position is outside of the box or no number,
    /// or the normal is none. Thread-safe.
    bool add(const float position[3], const float normal[3], std::uint32_t part, bool visible) noexcept;
    Sorted sorted() { return Sorted(*this); }

    static std::uint32_t part_of(std::uint64_t key) { return std::uint32_t(key & ((1u << part_bits) - 1)); }
    static std::uint32_t normal_of(std::uint64_t key) {
        return std::uint32_t(key >> part_bits & ((1u << normal_bits) - 1));
    }
    /// The cell, from the low side of the box on.
    static std::uint32_t cell_of(std::uint64_t key, std::size_t axis) {
        return std::uint32_t(key >> (part_bits + normal_bits + axis * axis_bits) & ((1u << axis_bits) - 1));
    }
    static std::array<float, 3> middle_normal(std::uint32_t number);

private:
    struct Slot {
        std::atomic<std::uint64_t> key, count; ///< of an empty one 0; rays that met nothing in the upper half
    };
    /// One of those that count how many are adding, in a cache line of its own.
    struct alignas(64) Adding {
        std::atomic<std::uint32_t> count{0};
    };
    static constexpr std::size_t kShares = 64;

    Adding& enter() noexcept;
    bool count(std::uint64_t key, std::uint64_t what, std::size_t most) noexcept;
    void close();
    void coarsen();
    void sort();

    std::array<float, 3> low_, high_;
    float step_ = 1.0f;
    std::size_t mask_, most_; ///< of slots; keys that it holds before it gets coarser
    std::unique_ptr<Slot[]> slots_;
    std::vector<VisibilityCount> spare_; ///< counts while cells become wider, and sorted ones
    std::atomic<std::uint32_t> shift_{0};
    std::atomic<std::size_t> used_{0};
    std::atomic<bool> closed_{false};
    std::unique_ptr<Adding[]> adding_;
    std::mutex mutex_; ///< of those that close it
};

} // namespace acdf::compress
