// An array that grows without exceptions. `failed` says that memory could not be had; additions are then lost.
#pragma once

#include "tables/scratch.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace acdf {

template <class T>
class Growable {
public:
    /// In `scratch`, which outlives it, or (null) in memory of its own.
    explicit Growable(Scratch* scratch = nullptr) noexcept : scratch_(scratch) {}
    Growable(const Growable&) = delete;
    Growable& operator=(const Growable&) = delete;
    ~Growable() {
        if (!scratch_) std::free(data_);
    }

    T* data() noexcept { return data_; }
    const T* data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }
    std::size_t bytes() const noexcept { return size_ * sizeof(T); }
    bool failed() const noexcept { return failed_; }
    T& operator[](std::size_t i) noexcept { return data_[i]; }
    const T& operator[](std::size_t i) const noexcept { return data_[i]; }

    void add(const T& value) noexcept {
        if (size_ < capacity_ || reserve(size_ + 1)) data_[size_++] = value;
    }
    /// Adds `count` copies; returns the first one, null where memory fails.
    T* add(std::size_t count, const T& value) noexcept {
        if (size_ + count > capacity_ && !reserve(size_ + count)) return nullptr;
        T* const first = data_ + size_;
        for (std::size_t i = 0; i < count; ++i) first[i] = value;
        size_ += count;
        return first;
    }
    void cut(std::size_t size) noexcept { size_ = size; }
    /// Makes room, twice what there was at least.
    bool reserve(std::size_t size) noexcept {
        if (size <= capacity_) return true;
        const std::size_t more = size > 2 * capacity_ ? size : 2 * capacity_;
        void* const room = scratch_
                               ? scratch_->grow(data_, size_ * sizeof(T), capacity_ * sizeof(T), more * sizeof(T))
                               : std::realloc(data_, more * sizeof(T));
        T* const moved = static_cast<T*>(room);
        if (!moved) {
            failed_ = true;
            return false;
        }
        data_ = moved;
        capacity_ = more;
        return true;
    }

private:
    Scratch* scratch_;
    T* data_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
    bool failed_ = false;
};

/// A count of words, rounded up to whole cache lines.
inline std::size_t whole_lines(std::size_t words) { return (words + 15) & ~std::size_t{15}; }

/// Copies an array to the word `at` of tables and moves that past it, to a whole line: what is left of the last one
/// becomes 0. Returns where the array begins.
template <class T>
std::uint32_t copy_lines(const Growable<T>& from, std::uint32_t* tables, std::size_t& at) noexcept {
    char* const begin = reinterpret_cast<char*>(tables + at);
    const std::size_t first = at, bytes = from.bytes();
    at = whole_lines(at + (bytes + 3) / 4);
    if (bytes > 0) std::memcpy(begin, from.data(), bytes);
    std::memset(begin + bytes, 0, 4 * (at - first) - bytes);
    return static_cast<std::uint32_t>(first);
}

} // namespace acdf
