#include "compress/visibility/counts.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace acdf::compress {
namespace {

constexpr std::uint64_t kOccupied = std::uint64_t{1} << 63;
constexpr std::uint64_t kOneRay = 1, kSeenRay = std::uint64_t{1} << 32;
constexpr std::uint32_t kMostRays = 0xF0000000u; ///< rays of a count: later ones are too many to change anything
constexpr std::size_t kMostThreads = 4096;       ///< that may each take a slot at once
constexpr std::uint32_t kFirstShift = 6;         ///< 512 cells along the longest side

std::uint64_t mixed_key(std::uint64_t z) { // SplitMix64 (Steele et al. 2014)
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
}

/// The same cell, twice as wide.
std::uint64_t wider(std::uint64_t key) {
    constexpr std::uint32_t begin = VisibilityCounts::part_bits + VisibilityCounts::normal_bits;
    std::uint64_t out = key & (kOccupied | ((std::uint64_t{1} << begin) - 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
        out |= std::uint64_t{VisibilityCounts::cell_of(key, axis) / 2}
               << (begin + axis * VisibilityCounts::axis_bits);
    return out;
}

/// The cell of a normal on the sides of a cube.
bool normal_number(const float normal[3], std::uint32_t& out) {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
    const float along = std::fabs(normal[axis]);
    if (!(along > 0.0f) || !std::isfinite(normal[0] + normal[1] + normal[2])) return false;
    constexpr float steps = VisibilityCounts::steps;
    const auto at = [&](std::size_t k) {
        const float x = 0.5f * (normal[(axis + k) % 3] / along + 1.0f) * steps;
        return std::uint32_t(std::clamp(x, 0.0f, steps - 1.0f));
    };
    out = (std::uint32_t(2 * axis + (normal[axis] < 0.0f)) * VisibilityCounts::steps + at(1)) *
              VisibilityCounts::steps +
          at(2);
    return true;
}

} // namespace

VisibilityCounts::VisibilityCounts(const std::array<float, 3>& low, const std::array<float, 3>& high,
                                   std::size_t slots)
    : low_(low), high_(high), mask_(slots - 1), most_(slots / 4 * 3), slots_(new Slot[slots]()),
      shift_(kFirstShift), adding_(new Adding[kShares]) {
    float longest = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, high[k] - low[k]);
    step_ = longest / float(1u << axis_bits);
    spare_.reserve(most_ + kMostThreads);
}

std::array<float, 3> VisibilityCounts::middle_normal(std::uint32_t number) {
    const std::uint32_t axis = number / (steps * steps) / 2;
    float out[3] = {};
    out[axis] = number / (steps * steps) % 2 ? -1.0f : 1.0f;
    out[(axis + 1) % 3] = 2.0f * (float(number / steps % steps) + 0.5f) / steps - 1.0f;
    out[(axis + 2) % 3] = 2.0f * (float(number % steps) + 0.5f) / steps - 1.0f;
    const float length = std::sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    return {out[0] / length, out[1] / length, out[2] / length};
}

/// Says that the calling thread is adding, once nobody has closed the grid.
VisibilityCounts::Adding& VisibilityCounts::enter() noexcept {
    static std::atomic<std::size_t> next{0};
    thread_local const std::size_t own = next++ % kShares;
    Adding& adding = adding_[own];
    while (true) {
        adding.count.fetch_add(1);
        if (!closed_.load()) return adding;
        adding.count.fetch_sub(1);
        while (closed_.load()) std::this_thread::yield();
    }
}

/// Waits until nobody is adding, and keeps others from it.
void VisibilityCounts::close() {
    closed_.store(true);
    for (std::size_t i = 0; i < kShares; ++i)
        while (adding_[i].count.load() != 0) std::this_thread::yield();
}

/// False where it takes a new slot, and `most` are used.
bool VisibilityCounts::count(std::uint64_t key, std::uint64_t what, std::size_t most) noexcept {
    for (std::size_t i = mixed_key(key) & mask_;; i = (i + 1) & mask_) {
        Slot& slot = slots_[i];
        std::uint64_t found = slot.key.load(std::memory_order_relaxed);
        if (found == 0) {
            if (used_.load(std::memory_order_relaxed) >= most) return false;
            if (slot.key.compare_exchange_strong(found, key)) {
                used_.fetch_add(1);
                found = key;
            }
        }
        if (found != key) continue;
        if (std::uint32_t(slot.count.load(std::memory_order_relaxed)) < kMostRays)
            slot.count.fetch_add(what, std::memory_order_relaxed);
        return true;
    }
}

bool VisibilityCounts::add(const float position[3], const float normal[3], std::uint32_t part,
                           bool visible) noexcept {
    std::uint32_t number = 0, cell[3];
    if (!normal_number(normal, number)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        if (!(position[k] >= low_[k] && position[k] <= high_[k])) return false;
        cell[k] = std::min(std::uint32_t((position[k] - low_[k]) / step_), (1u << axis_bits) - 1);
    }
    const auto try_to_count = [&] {
        const std::uint32_t shift = shift_.load(std::memory_order_relaxed);
        std::uint64_t key = kOccupied | std::uint64_t{number} << part_bits | part;
        for (std::size_t k = 0; k < 3; ++k)
            key |= std::uint64_t{cell[k] >> shift} << (part_bits + normal_bits + k * axis_bits);
        return count(key, kOneRay + (visible ? kSeenRay : 0), most_);
    };
    Adding& adding = enter();
    const bool counted = try_to_count();
    adding.count.fetch_sub(1);
    if (counted) return true;
    const std::lock_guard<std::mutex> lock(mutex_);
    close();
    while (!try_to_count()) coarsen(); // others may have made room, or the slot
    closed_.store(false);
    return true;
}

/// Makes cells twice as wide. The grid is closed.
void VisibilityCounts::coarsen() {
    spare_.clear();
    for (std::size_t i = 0; i <= mask_; ++i) {
        const std::uint64_t key = slots_[i].key.load(), counts = slots_[i].count.load();
        if (key != 0) spare_.push_back({wider(key), std::uint32_t(counts), std::uint32_t(counts >> 32)});
        slots_[i].key.store(0);
        slots_[i].count.store(0);
    }
    used_.store(0);
    shift_.fetch_add(1);
    for (const VisibilityCount& one : spare_) count(one.key, one.all + (std::uint64_t{one.seen} << 32), mask_);
}

/// All counts into spare_. The grid is closed.
void VisibilityCounts::sort() {
    while (used_.load() > most_) coarsen();
    spare_.clear();
    for (std::size_t i = 0; i <= mask_; ++i)
        if (const std::uint64_t key = slots_[i].key.load(), counts = slots_[i].count.load(); key != 0)
            spare_.push_back({key, std::uint32_t(counts), std::uint32_t(counts >> 32)});
}

VisibilityCounts::Sorted::Sorted(VisibilityCounts& of)
    : lock_(of.mutex_), counts_(of.spare_), low_(of.low_), high_(of.high_) {
    of.close();
    of.sort();
    width_ = of.step_ * static_cast<float>(1u << of.shift_.load());
    of.closed_.store(false);
    std::sort(of.spare_.begin(), of.spare_.end(),
              [](const VisibilityCount& a, const VisibilityCount& b) { return a.key < b.key; });
}

} // namespace acdf::compress
