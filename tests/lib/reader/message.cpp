// Texts of errors are those that printf writes (lib/reader/message.h).
#include "reader/message.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>

namespace {

template <class... Values>
void expect_as_printf(const char* format, Values... values) {
    char ours[200], theirs[200];
    acdf::write_message(ours, sizeof ours, format, values...);
    std::snprintf(theirs, sizeof theirs, format, values...);
    EXPECT_STREQ(ours, theirs);
}

TEST(Message, isThatOfPrintf) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const std::uint64_t bits = random();
        const auto low = static_cast<std::uint32_t>(bits);
        expect_as_printf("%llu: %08x, %02x %04x; %u", static_cast<unsigned long long>(bits >> i % 64), low,
                         low >> 24, low >> 16, low);
        expect_as_printf("%s%s", i % 2 ? "a" : "", "bc");
    }
}

TEST(Message, isCutWhereThereIsNoRoom) {
    char text[4] = {'x', 'x', 'x', 'x'};
    acdf::write_message(text, sizeof text, "%u is too long", 12u);
    EXPECT_STREQ(text, "12 ");
}

} // namespace
