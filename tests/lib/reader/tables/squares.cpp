// Grids over squares of keys: a query with a key of a box, its corners among them, finds the box, and few
// others.
#include "reader/tables/squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <random>
#include <vector>

namespace {

using acdf::KeySpan;
using u32 = std::uint32_t;

struct KeyBox {
    KeySpan span[2];
};

// The square of keys of so many bits in `count` boxes: each time one is divided anywhere along either axis.
std::vector<KeyBox> random_boxes(std::size_t count, u32 bits, u32 seed) {
    std::mt19937 random(seed);
    std::vector<KeyBox> boxes = {{{{0, (1u << bits) - 1}, {0, (1u << bits) - 1}}}};
    while (boxes.size() < count) {
        const std::size_t i = random() % boxes.size(), axis = random() % 2;
        KeySpan& span = boxes[i].span[axis];
        if (span.low == span.high) continue;
        KeyBox upper = boxes[i];
        const u32 middle = span.low + 1 + static_cast<u32>(random()) % (span.high - span.low);
        upper.span[axis].low = middle;
        span.high = middle - 1;
        boxes.push_back(upper);
    }
    return boxes;
}

struct Squares {
    std::vector<u32> words;

    const AcdfSquares& at() const { return *reinterpret_cast<const AcdfSquares*>(words.data()); }
    // How many boxes may hold keys; -1 where box i is not among them.
    int asked(u32 key0, u32 key1, std::size_t i) const {
        const std::uint16_t* cells;
        int named = 0;
        bool told = false;
        for (u32 mask = acdf_squares_find(words.data(), &at(), key0, key1, &cells); mask; mask &= mask - 1, ++named)
            told = told || cells[acdf_lowest_bit(mask)] == i;
        return told ? named : -1;
    }
};

Squares made(const std::vector<KeyBox>& boxes, u32 bits) {
    acdf::KeyBoxes keys;
    acdf::SquaresMaker maker;
    Squares out;
    for (const KeyBox& box : boxes) keys.add(box.span[0], box.span[1]);
    EXPECT_TRUE(maker.make(keys, bits, std::size_t{1} << 14));
    EXPECT_TRUE(maker.complete());
    out.words.resize(16 + maker.words() + 16); // whole cache lines, wherever they begin
    maker.place(out.words.data(), 16, *new (out.words.data()) AcdfSquares());
    return out;
}

TEST(Squares, FindEachBox) {
    for (const u32 bits : {6u, 12u, 25u, 31u})
        for (const std::size_t count : {1u, 15u, 16u, 17u, 300u, 3000u}) {
            SCOPED_TRACE(testing::Message() << count << " boxes, " << bits << " bits");
            const std::vector<KeyBox> boxes = random_boxes(count, bits, static_cast<u32>(count) + bits);
            const Squares squares = made(boxes, bits);
            std::size_t named = 0, asked = 0;
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const KeySpan *const x = &boxes[i].span[0], *const y = &boxes[i].span[1];
                for (const u32 key0 : {x->low, x->low + (x->high - x->low) / 2, x->high})
                    for (const u32 key1 : {y->low, y->low + (y->high - y->low) / 2, y->high}) {
                        const int told = squares.asked(key0, key1, i);
                        ASSERT_GT(told, 0) << "box " << i << " at " << key0 << ", " << key1;
                        named += static_cast<std::size_t>(told);
                        ++asked;
                    }
            }
            EXPECT_LT(named, 3 * asked); // corners have neighbours
        }
}

// A box without keys of an axis is found nowhere, and what lies beside is as it was.
TEST(Squares, LeaveOutBoxesWithoutKeys) {
    std::vector<KeyBox> boxes = random_boxes(200, 20, 1);
    for (std::size_t i = 0; i < boxes.size(); i += 3) boxes[i].span[i % 2] = {1, 0};
    const Squares squares = made(boxes, 20);
    std::mt19937 random(2);
    for (int k = 0; k < 5000; ++k) {
        const u32 keys[2] = {static_cast<u32>(random()) >> 12, static_cast<u32>(random()) >> 12};
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const KeySpan* const spans = boxes[i].span;
            const bool in = spans[0].low <= keys[0] && keys[0] <= spans[0].high && spans[1].low <= keys[1] &&
                            keys[1] <= spans[1].high;
            const int told = squares.asked(keys[0], keys[1], i);
            ASSERT_TRUE(!in || told > 0) << "box " << i;
            ASSERT_TRUE(i % 3 != 0 || told < 0) << "box " << i;
        }
    }
}

} // namespace
