// The inflate that WebAssembly has in place of zlib, beside zlib: the same bytes, the same refusals, nothing
// outside its room.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

extern "C" {
/// inflate.c under another name: result of inflate; *size: room, then what was written; *left: input that is left.
int web_inflate(const std::uint8_t* in, std::size_t in_size, std::uint8_t* out, std::size_t* size,
                std::size_t* left);
unsigned long web_crc32(unsigned long crc, const std::uint8_t* bytes, std::size_t size);
}

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Inflated {
    int result = 0;
    Bytes bytes;
    std::size_t left = 0;
};

Inflated by_zlib(const Bytes& in, std::size_t room) {
    Inflated out;
    out.bytes.resize(room + 1);
    z_stream stream = {};
    inflateInit(&stream);
    stream.next_in = const_cast<std::uint8_t*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = out.bytes.data();
    stream.avail_out = static_cast<uInt>(room);
    out.result = inflate(&stream, Z_NO_FLUSH);
    out.left = stream.avail_in;
    out.bytes.resize(room - stream.avail_out);
    inflateEnd(&stream);
    return out;
}

Inflated by_ours(const Bytes& in, std::size_t room) {
    Inflated out;
    const Bytes exact(in); // sanitizers see reads beyond
    out.bytes.resize(room);
    std::uint8_t nothing = 0;
    out.result = web_inflate(exact.data(), exact.size(), room ? out.bytes.data() : &nothing, &room, &out.left);
    out.bytes.resize(room);
    return out;
}

Bytes deflated(const Bytes& bytes, int level, int strategy) {
    Bytes out(compressBound(static_cast<uLong>(bytes.size())) + 64);
    z_stream stream = {};
    deflateInit2(&stream, level, Z_DEFLATED, 15, 8, strategy);
    stream.next_in = const_cast<std::uint8_t*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(out.size() - stream.avail_out);
    deflateEnd(&stream);
    return out;
}

/// From random bytes to long repeats.
Bytes text(std::mt19937& random, std::size_t size) {
    Bytes bytes(size);
    const unsigned kinds = 1 + static_cast<unsigned>(random() % 256);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] =
            static_cast<std::uint8_t>(i > 40 && random() % 3 ? bytes[i - 1 - random() % 40] : random() % kinds);
    return bytes;
}

TEST(WebInflate, GivesBackWhatZlibDeflated) {
    std::mt19937 random(1);
    for (int i = 0; i < 80; ++i) {
        const Bytes bytes = text(random, i < 20 ? static_cast<std::size_t>(i) : random() % 100000);
        for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED}) {
            const Bytes stream = deflated(bytes, static_cast<int>(random() % 10), strategy);
            const Inflated ours = by_ours(stream, bytes.size());
            ASSERT_EQ(ours.result, Z_STREAM_END) << i;
            ASSERT_EQ(ours.bytes, bytes) << i;
            ASSERT_EQ(ours.left, 0u);
        }
    }
}

TEST(WebInflate, LeavesWhatFollows) {
    Bytes stream = deflated({1, 2, 3, 4, 5, 6, 7}, 9, Z_DEFAULT_STRATEGY);
    stream.insert(stream.end(), {9, 9, 9});
    const Inflated ours = by_ours(stream, 7);
    EXPECT_EQ(ours.result, Z_STREAM_END);
    EXPECT_EQ(ours.left, 3u);
}

// Every length of the stream and of the room, and damage of every kind: never accepted where zlib refuses, nor the
// other way round, and the same bytes where both do.
TEST(WebInflate, RefusesWhatZlibRefuses) {
    std::mt19937 random(2);
    const Bytes bytes = text(random, 3000);
    for (const int strategy : {Z_DEFAULT_STRATEGY, Z_FIXED, Z_HUFFMAN_ONLY}) {
        const Bytes stream = deflated(bytes, 6, strategy), stored = deflated(bytes, 0, strategy);
        for (const Bytes& whole : {stream, stored}) {
            for (std::size_t size = 0; size < whole.size(); ++size)
                ASSERT_NE(
                    by_ours(Bytes(whole.begin(), whole.begin() + static_cast<long>(size)), bytes.size()).result,
                    Z_STREAM_END);
            for (std::size_t room = 0; room < bytes.size(); room += 7)
                ASSERT_EQ(by_ours(whole, room).result, Z_BUF_ERROR) << room;
            for (int i = 0; i < 2000; ++i) {
                Bytes damaged = whole;
                for (std::size_t k = 0; k <= random() % 3; ++k)
                    damaged[random() % (i % 2 ? 40 : damaged.size())] ^=
                        static_cast<std::uint8_t>(1 << random() % 8);
                const Inflated ours = by_ours(damaged, bytes.size()), zlib = by_zlib(damaged, bytes.size());
                ASSERT_EQ(ours.result == Z_STREAM_END, zlib.result == Z_STREAM_END) << i;
                if (zlib.result == Z_STREAM_END) {
                    ASSERT_EQ(ours.bytes, zlib.bytes) << i;
                }
            }
        }
    }
}

TEST(WebInflate, Crc32IsZlibs) {
    std::mt19937 random(3);
    const Bytes bytes = text(random, 10000);
    EXPECT_EQ(web_crc32(0, bytes.data(), bytes.size()), crc32_z(0, bytes.data(), bytes.size()));
    EXPECT_EQ(web_crc32(web_crc32(0, bytes.data(), 60), bytes.data() + 60, 9940),
              crc32_z(0, bytes.data(), bytes.size()));
    EXPECT_EQ(web_crc32(0, nullptr, 0), 0u);
}

} // namespace
