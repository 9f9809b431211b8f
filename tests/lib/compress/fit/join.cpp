// join_neighbours against a reference that looks at every pair again before each join.
#include "tests/inputs/synthetic.h"

#include "compress/fit/join.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace {

using acdf::compress::join_neighbours;

/// A cell of measure m that holds the integral e of f^2 costs sqrt(m e).
struct Item {
    double measure, energy;
    double cost() const { return std::sqrt(measure * energy); }
};

Item joined(const Item& a, const Item& b) { return {a.measure + b.measure, a.energy + b.energy}; }

double raise_of(const Item& a, const Item& b) { return joined(a, b).cost() - a.cost() - b.cost(); }

std::vector<Item> random_items(std::uint64_t seed, std::size_t n) {
    std::mt19937_64 random(seed);
    std::vector<Item> items;
    for (std::size_t i = 0; i < n; ++i)
        items.push_back({0.5 + acdf_test::uniform(random), std::pow(10.0, 4.0 * acdf_test::uniform(random))});
    return items;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The first of the cheapest pairs, looked for from scratch each time.
Pairs slow_joins(std::vector<Item> items, std::size_t joins) {
    std::vector<std::size_t> alive(items.size());
    for (std::size_t i = 0; i < alive.size(); ++i) alive[i] = i;
    Pairs done;
    while (done.size() < joins && alive.size() > 1) {
        std::size_t best = 0;
        double least = INFINITY;
        for (std::size_t k = 0; k + 1 < alive.size(); ++k) {
            const double raise = raise_of(items[alive[k]], items[alive[k + 1]]);
            if (raise < least) least = raise, best = k;
        }
        done.push_back({alive[best], alive[best + 1]});
        items[alive[best]] = joined(items[alive[best]], items[alive[best + 1]]);
        alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
    return done;
}

Pairs fast_joins(std::vector<Item> items, std::size_t joins) {
    Pairs done;
    join_neighbours(
        items.size(), joins, [&](std::size_t a, std::size_t b) { return raise_of(items[a], items[b]); },
        [&](std::size_t a, std::size_t b, double) {
            items[a] = joined(items[a], items[b]);
            done.push_back({a, b});
        });
    return done;
}

RC_GTEST_PROP(JoinNeighbours, JoinsTheCheapestPairEachTime, ()) {
    const auto n = *rc::gen::inRange<std::size_t>(1, 80);
    const auto items = random_items(*rc::gen::inRange<std::uint64_t>(0, 1u << 30), n);
    const auto joins = *rc::gen::inRange<std::size_t>(0, 90);
    RC_ASSERT(fast_joins(items, joins) == slow_joins(items, joins));
}

RC_GTEST_PROP(JoinNeighbours, RaisesTheSumByWhatItPredicts, ()) {
    const auto n = *rc::gen::inRange<std::size_t>(2, 80);
    auto items = random_items(*rc::gen::inRange<std::uint64_t>(0, 1u << 30), n);
    const auto joins = *rc::gen::inRange<std::size_t>(0, n);
    double before = 0.0, predicted = 0.0, after = 0.0;
    for (const Item& item : items) before += item.cost();
    std::vector<bool> alive(n, true);
    join_neighbours(
        n, joins, [&](std::size_t a, std::size_t b) { return raise_of(items[a], items[b]); },
        [&](std::size_t a, std::size_t b, double raise) {
            RC_ASSERT(raise >= -1e-9); // Cauchy-Schwarz
            predicted += raise;
            items[a] = joined(items[a], items[b]);
            alive[b] = false;
        });
    for (std::size_t i = 0; i < n; ++i) after += alive[i] ? items[i].cost() : 0.0;
    RC_ASSERT(std::abs(after - before - predicted) < 1e-9 * after);
}

TEST(JoinNeighbours, TiesGoToTheLeftmostPair) {
    const std::vector<Item> equal(6, Item{1.0, 1.0});
    EXPECT_EQ(fast_joins(equal, 5), slow_joins(equal, 5));
    EXPECT_EQ(fast_joins(equal, 1), (Pairs{{0, 1}}));
}

TEST(JoinNeighbours, NothingToJoin) {
    EXPECT_TRUE(fast_joins({}, 3).empty());
    EXPECT_TRUE(fast_joins({{1.0, 1.0}}, 3).empty());
    EXPECT_TRUE(fast_joins({{1.0, 1.0}, {1.0, 2.0}}, 0).empty());
}

} // namespace
