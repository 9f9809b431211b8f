/* lib/web/zlib/inflate.c by the side of zlib. */
#define inflate acdf_web_inflate
#define crc32_z acdf_web_crc32_z
#include "web/zlib/inflate.c"

int web_inflate(const uint8_t* in, size_t in_size, uint8_t* out, size_t* size, size_t* left);
unsigned long web_crc32(unsigned long crc, const uint8_t* bytes, size_t size);

int web_inflate(const uint8_t* in, size_t in_size, uint8_t* out, size_t* size, size_t* left) {
    z_stream stream = {(Bytef*)in, (uInt)in_size, out, (uInt)*size};
    const int result = inflate(&stream, Z_NO_FLUSH);
    *size -= stream.avail_out;
    *left = stream.avail_in;
    return result;
}
unsigned long web_crc32(unsigned long crc, const uint8_t* bytes, size_t size) { return crc32_z(crc, bytes, size); }
