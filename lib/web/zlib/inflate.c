/* RFC 1950 and RFC 1951, and the CRC-32 of RFC 1952. Any bytes may be passed in. */
#include "zlib.h"

#include <string.h>

enum { LITERALS = 288, DISTANCES = 32, LONGEST_CODE = 15 };

typedef struct Input {
    const Bytef* at;
    const Bytef* end;
    uint32_t bits; /* that were read and not used, the next one lowest */
    unsigned count;
    int failed;
} Input;

typedef struct Room {
    Bytef* begin;
    Bytef* at;
    Bytef* end;
} Room;

/* A canonical prefix code: how many codes have each length, and their symbols in order. */
typedef struct Code {
    uint16_t count[LONGEST_CODE + 1];
    uint16_t symbol[LITERALS];
} Code;

/* `count` bits, at most 16; 0 where the input has ended. */
static uint32_t take(Input* in, unsigned count) {
    uint32_t value;
    while (in->count < count) {
        if (in->at == in->end) {
            in->failed = 1;
            return 0;
        }
        in->bits |= (uint32_t)*in->at++ << in->count;
        in->count += 8;
    }
    value = in->bits & ((1u << count) - 1);
    in->bits >>= count;
    in->count -= count;
    return value;
}

/* Returns 0 where lengths are no code: too many of one length, or codes that nothing has, but for a single one. */
static int make_code(Code* code, const uint8_t* lengths, unsigned count) {
    uint16_t next[LONGEST_CODE + 2] = {0};
    int left = 1;
    unsigned i;
    memset(code->count, 0, sizeof code->count);
    for (i = 0; i < count; ++i) ++code->count[lengths[i]];
    for (i = 1; i <= LONGEST_CODE; ++i) {
        left = 2 * left - code->count[i];
        if (left < 0) return 0;
        next[i + 1] = (uint16_t)(next[i] + code->count[i]);
    }
    for (i = 0; i < count; ++i)
        if (lengths[i]) code->symbol[next[lengths[i]]++] = (uint16_t)i;
    return left == 0 || count - code->count[0] <= 1;
}

/* The next symbol; -1 where there is none. */
static int symbol_of(Input* in, const Code* code) {
    int first = 0, index = 0, bits = 0;
    unsigned length;
    for (length = 1; length <= LONGEST_CODE; ++length) {
        const int count = code->count[length];
        bits |= (int)take(in, 1);
        if (in->failed) return -1;
        if (bits - first < count) return code->symbol[index + bits - first];
        index += count;
        first = (first + count) << 1;
        bits <<= 1;
    }
    return -1;
}

static int copy_match(Room* out, size_t distance, size_t length) {
    if (distance > (size_t)(out->at - out->begin)) return Z_DATA_ERROR;
    for (; length > 0; --length) {
        if (out->at == out->end) return Z_BUF_ERROR;
        *out->at = *(out->at - distance);
        ++out->at;
    }
    return Z_OK;
}

static int inflate_symbols(Input* in, Room* out, const Code* literals, const Code* distances) {
    static const uint16_t length_base[29] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                             31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
    static const uint8_t length_bits[29] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                            2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    static const uint16_t distance_base[30] = {1,    2,    3,    4,    5,    7,    9,    13,    17,    25,
                                               33,   49,   65,   97,   129,  193,  257,  385,   513,   769,
                                               1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    for (;;) {
        int symbol = symbol_of(in, literals), result;
        size_t length;
        if (symbol < 0) return Z_DATA_ERROR;
        if (symbol == 256) return Z_OK;
        if (symbol < 256) {
            if (out->at == out->end) return Z_BUF_ERROR;
            *out->at++ = (Bytef)symbol;
            continue;
        }
        if (symbol > 285) return Z_DATA_ERROR;
        length = length_base[symbol - 257] + take(in, length_bits[symbol - 257]);
        symbol = symbol_of(in, distances);
        if (symbol < 0 || symbol > 29) return Z_DATA_ERROR;
        result =
            copy_match(out, distance_base[symbol] + take(in, symbol < 4 ? 0u : (unsigned)symbol / 2 - 1), length);
        if (in->failed) return Z_DATA_ERROR;
        if (result != Z_OK) return result;
    }
}

static int inflate_stored(Input* in, Room* out) {
    uint32_t length, inverse;
    size_t room;
    take(in, in->count & 7);
    length = take(in, 16);
    inverse = take(in, 16);
    if (in->failed || length != (~inverse & 0xFFFFu)) return Z_DATA_ERROR;
    in->at -= in->count / 8; /* whole bytes that were read ahead */
    in->bits = 0;
    in->count = 0;
    if (length > (size_t)(in->end - in->at)) return Z_DATA_ERROR;
    room = (size_t)(out->end - out->at);
    memcpy(out->at, in->at, length < room ? length : room);
    out->at += length < room ? length : room;
    in->at += length;
    return length > room ? Z_BUF_ERROR : Z_OK;
}

static int inflate_fixed(Input* in, Room* out) {
    uint8_t lengths[LITERALS];
    Code literals, distances;
    memset(lengths, 8, 144);
    memset(lengths + 144, 9, 112);
    memset(lengths + 256, 7, 24);
    memset(lengths + 280, 8, 8);
    make_code(&literals, lengths, LITERALS);
    memset(lengths, 5, DISTANCES);
    make_code(&distances, lengths, DISTANCES);
    return inflate_symbols(in, out, &literals, &distances);
}

/* The lengths of both codes of a block, `count` in all; 0 where they are damaged. */
static int read_lengths(Input* in, uint8_t* lengths, unsigned count) {
    static const uint8_t order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    const unsigned given = take(in, 4) + 4;
    uint8_t code_lengths[19] = {0};
    Code code;
    unsigned i;
    for (i = 0; i < given; ++i) code_lengths[order[i]] = (uint8_t)take(in, 3);
    if (in->failed || !make_code(&code, code_lengths, 19)) return 0;
    for (i = 0; i < count;) {
        const int symbol = symbol_of(in, &code);
        unsigned times;
        if (symbol < 0 || (symbol == 16 && i == 0)) return 0;
        if (symbol < 16) {
            lengths[i++] = (uint8_t)symbol;
            continue;
        }
        times = symbol == 16 ? 3 + take(in, 2) : symbol == 17 ? 3 + take(in, 3) : 11 + take(in, 7);
        if (in->failed || times > count - i) return 0;
        memset(lengths + i, symbol == 16 ? lengths[i - 1] : 0, times);
        i += times;
    }
    return lengths[256] != 0;
}

static int inflate_dynamic(Input* in, Room* out) {
    const unsigned literal_count = take(in, 5) + 257, distance_count = take(in, 5) + 1;
    uint8_t lengths[LITERALS + DISTANCES] = {0};
    Code literals, distances;
    if (literal_count > 286 || distance_count > 30 || !read_lengths(in, lengths, literal_count + distance_count))
        return Z_DATA_ERROR;
    if (!make_code(&literals, lengths, literal_count) ||
        !make_code(&distances, lengths + literal_count, distance_count))
        return Z_DATA_ERROR;
    return inflate_symbols(in, out, &literals, &distances);
}

static int inflate_blocks(Input* in, Room* out) {
    uint32_t last = 0;
    while (!last) {
        uint32_t kind;
        int result = Z_DATA_ERROR;
        last = take(in, 1);
        kind = take(in, 2);
        if (in->failed) return Z_DATA_ERROR;
        if (kind == 0) result = inflate_stored(in, out);
        if (kind == 1) result = inflate_fixed(in, out);
        if (kind == 2) result = inflate_dynamic(in, out);
        if (result != Z_OK) return result;
    }
    return Z_OK;
}

static uint32_t adler32_of(const Bytef* bytes, size_t size) {
    uint32_t low = 1, high = 0;
    while (size > 0) {
        size_t step = size < 5552 ? size : 5552; /* sums of so many stay below 2^32 */
        for (size -= step; step > 0; --step) {
            low += *bytes++;
            high += low;
        }
        low %= 65521;
        high %= 65521;
    }
    return high << 16 | low;
}

static int inflate_stream(Input* in, Room* out) {
    const uint32_t method = take(in, 8), flags = take(in, 8);
    uint32_t sum = 0;
    int result, i;
    if (in->failed || (method & 15) != 8 || method >> 4 > 7 || (method << 8 | flags) % 31 != 0 || flags & 32)
        return Z_DATA_ERROR;
    result = inflate_blocks(in, out);
    if (result != Z_OK) return result;
    take(in, in->count & 7);
    for (i = 0; i < 4; ++i) sum = sum << 8 | take(in, 8);
    if (in->failed || sum != adler32_of(out->begin, (size_t)(out->at - out->begin))) return Z_DATA_ERROR;
    return Z_STREAM_END;
}

int inflate(z_stream* stream, int flush) {
    Bytef nothing = 0; /* stands for null pointers, to which C adds nothing */
    Bytef* from = stream->next_in ? stream->next_in : &nothing;
    Bytef* to = stream->next_out ? stream->next_out : &nothing;
    Input in = {from, from + stream->avail_in, 0, 0, 0};
    Room out = {to, to, to + stream->avail_out};
    const int result = inflate_stream(&in, &out);
    (void)flush;
    in.at -= in.count / 8; /* whole bytes that were read ahead */
    stream->avail_in = (uInt)(in.end - in.at);
    if (stream->next_in) stream->next_in = from + (in.at - from);
    stream->avail_out = (uInt)(out.end - out.at);
    if (stream->next_out) stream->next_out = out.at;
    return result;
}

unsigned long crc32_z(unsigned long crc, const Bytef* bytes, size_t size) {
    static uint32_t table[256]; /* the same whichever thread makes it; WebAssembly has one */
    uint32_t value = ~(uint32_t)crc;
    size_t i;
    if (table[1] == 0) {
        uint32_t k;
        for (k = 0; k < 256; ++k) {
            uint32_t entry = k;
            int bit;
            for (bit = 0; bit < 8; ++bit) entry = entry >> 1 ^ (0xEDB88320u & (0u - (entry & 1)));
            table[k] = entry;
        }
    }
    for (i = 0; i < size; ++i) value = value >> 8 ^ table[(value ^ bytes[i]) & 255];
    return ~value & 0xFFFFFFFFul;
}
