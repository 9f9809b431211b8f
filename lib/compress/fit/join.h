// Joining neighbours bottom-up, the cheapest pair first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// Items in a line that vanish one by one, and what joining each with its right neighbour costs. For few items: the
/// cheapest pair is looked for among all that are left.
class ShortLine {
public:
    static constexpr std::size_t longest = 24;

    template <class Raise>
    ShortLine(std::size_t count, const Raise& raise) : count_(count) {
        for (std::size_t i = 0; i < count; ++i) item_[i] = static_cast<std::uint32_t>(i);
        for (std::size_t i = 0; i + 1 < count; ++i) raise_[i] = raise(i, i + 1);
    }

    std::size_t size() const { return count_; }
    template <class Raise, class Join>
    void join_cheapest(const Raise& raise, const Join& join) {
        std::size_t k = 0;
        for (std::size_t i = 1; i + 1 < count_; ++i)
            if (raise_[i] < raise_[k]) k = i;
        join(std::size_t{item_[k]}, std::size_t{item_[k + 1]}, raise_[k]);
        --count_;
        for (std::size_t i = k + 1; i < count_; ++i) item_[i] = item_[i + 1];
        for (std::size_t i = k; i + 1 < count_; ++i) raise_[i] = raise_[i + 1];
        if (k + 1 < count_) raise_[k] = raise(item_[k], item_[k + 1]);
        if (k > 0) raise_[k - 1] = raise(item_[k - 1], item_[k]);
    }

private:
    std::size_t count_;
    std::array<std::uint32_t, longest> item_;
    std::array<double, longest> raise_;
};

/// The same for many items: a tournament of pairs.
class LongLine {
public:
    template <class Raise>
    LongLine(std::size_t count, const Raise& raise) : count_(count), leaves_(1) {
        while (leaves_ + 1 < count) leaves_ *= 2;
        next_.resize(count);
        previous_.resize(count);
        raise_.assign(leaves_, gone);
        winner_.resize(2 * leaves_);
        for (std::size_t i = 0; i < count; ++i) {
            next_[i] = i + 1 < count ? static_cast<std::uint32_t>(i + 1) : none;
            previous_[i] = i > 0 ? static_cast<std::uint32_t>(i - 1) : none;
            if (i + 1 < count) raise_[i] = least_of(raise(i, i + 1));
        }
        for (std::size_t i = 0; i < leaves_; ++i) winner_[leaves_ + i] = static_cast<std::uint32_t>(i);
        for (std::size_t node = leaves_; node-- > 1;) play(node);
    }

    std::size_t size() const { return count_; }
    template <class Raise, class Join>
    void join_cheapest(const Raise& raise, const Join& join) {
        const std::uint32_t a = winner_[1], b = next_[a];
        join(std::size_t{a}, std::size_t{b}, raise_[a]);
        --count_;
        next_[a] = next_[b];
        if (next_[a] != none) {
            previous_[next_[a]] = a;
            set(b, gone);
        }
        set(a, next_[a] == none ? gone : least_of(raise(a, next_[a])));
        if (previous_[a] != none) set(previous_[a], least_of(raise(previous_[a], a)));
    }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    static constexpr double gone = std::numeric_limits<double>::infinity();

    /// A pair that is left goes before all that are gone, whatever it costs.
    static double least_of(double raise) { return raise < gone ? raise : std::numeric_limits<double>::max(); }
    /// The leftmost of equal pairs wins.
    void play(std::size_t node) {
        const std::uint32_t left = winner_[2 * node], right = winner_[2 * node + 1];
        winner_[node] = raise_[left] <= raise_[right] ? left : right;
    }
    /// Matches that others won before and after are as they were, and so are all above them.
    void set(std::uint32_t pair, double raise) {
        raise_[pair] = raise;
        for (std::size_t node = (leaves_ + pair) / 2; node > 0; node /= 2) {
            const std::uint32_t before = winner_[node];
            play(node);
            if (before != pair && winner_[node] == before) return;
        }
    }

    std::size_t count_, leaves_;
    std::vector<std::uint32_t> next_, previous_; ///< one an item
    std::vector<double> raise_;                  ///< one a pair, by its left item; `gone` where there is none
    std::vector<std::uint32_t> winner_;          ///< of the matches of the tournament: the pair, from 1 on
};

/// Performs up to `joins` joins among `count` items in a line. `raise(a, b)` returns what joining item a with
/// its right neighbour b costs; `join(a, b, cost)` makes a stand for both and b vanish.
/// Ties go to the leftmost pair. O(count log count) calls.
template <class Raise, class Join>
void join_neighbours(std::size_t count, std::size_t joins, const Raise& raise, const Join& join) {
    const auto run = [&](auto&& line) {
        for (; joins > 0 && line.size() > 1; --joins) line.join_cheapest(raise, join);
    };
    if (count <= ShortLine::longest) run(ShortLine(count, raise));
    else run(LongLine(count, raise));
}

} // namespace acdf::compress
