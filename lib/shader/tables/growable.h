// An array that grows without exceptions. `failed` says that memory could not be had; additions are then lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace acdf {

template <class T>
class Growable {
public:
    Growable() noexcept = default;
    Growable(const Growable&) = delete;
    Growable& operator=(const Growable&) = delete;
    ~Growable() { std::free(data_); }

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
        if (!reserve(size_ + count)) return nullptr;
        T* const first = data_ + size_;
        for (std::size_t i = 0; i < count; ++i) first[i] = value;
        size_ += count;
        return first;
    }
    /// Makes room, twice what there was at least.
    bool reserve(std::size_t size) noexcept {
        if (size <= capacity_) return true;
        const std::size_t more = size > 2 * capacity_ ? size : 2 * capacity_;
        T* const moved = static_cast<T*>(std::realloc(data_, more * sizeof(T)));
        if (!moved) {
            failed_ = true;
            return false;
        }
        data_ = moved;
        capacity_ = more;
        return true;
    }

private:
    T* data_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0;
    bool failed_ = false;
};

} // namespace acdf
