#include "inflate.h"

#include <cstddef>

#if ACDF_ZLIB
#include <zlib.h>
#endif

namespace acdf {

#if ACDF_ZLIB

u32 crc32_of(u32 seed, const u8* bytes, u64 size) noexcept {
    return static_cast<u32>(crc32_z(seed, bytes, static_cast<std::size_t>(size)));
}

const char* inflate_within(const u8* in, u64 in_size, u8* out, u64& out_size) noexcept {
    constexpr u64 step = u64{1} << 30; // zlib counts in 32 bits
    z_stream stream = {};
    if (inflateInit(&stream) != Z_OK) return "zlib cannot start";
    stream.next_in = const_cast<u8*>(in);
    stream.next_out = out;
    u64 in_left = in_size, out_left = out_size;
    int result = Z_OK;
    while (result == Z_OK) {
        const uInt in_now = static_cast<uInt>(in_left < step ? in_left : step);
        const uInt out_now = static_cast<uInt>(out_left < step ? out_left : step);
        stream.avail_in = in_now;
        stream.avail_out = out_now;
        result = ::inflate(&stream, Z_NO_FLUSH);
        in_left -= in_now - stream.avail_in;
        out_left -= out_now - stream.avail_out;
        if (result == Z_OK && stream.avail_in == in_now && stream.avail_out == out_now) break; // no progress
    }
    inflateEnd(&stream);
    if (result != Z_STREAM_END) return out_left == 0 ? "it goes on after `raw_length`" : "the stream is damaged";
    out_size -= out_left;
    return in_left != 0 ? "bytes follow the stream" : nullptr;
}

#else

// Half a byte at a time: 64 bytes of table.
u32 crc32_of(u32 seed, const u8* bytes, u64 size) noexcept {
    static constexpr u32 table[16] = {0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4,
                                      0x4DB26158, 0x5005713C, 0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
                                      0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
    u32 crc = ~seed;
    for (u64 i = 0; i < size; ++i) {
        crc ^= bytes[i];
        crc = crc >> 4 ^ table[crc & 15];
        crc = crc >> 4 ^ table[crc & 15];
    }
    return ~crc;
}

const char* inflate_within(const u8*, u64, u8*, u64&) noexcept {
    return "it is deflated, and this reader was compiled without zlib; make the file with `--compress none`";
}

#endif

const char* inflate(const u8* in, u64 in_size, u8* out, u64 size) noexcept {
    u64 inflated = size;
    const char* wrong = inflate_within(in, in_size, out, inflated);
    return inflated != size ? "it ends before `raw_length`" : wrong;
}

} // namespace acdf
