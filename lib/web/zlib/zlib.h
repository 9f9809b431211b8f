/* As much of zlib as the reader asks for, for WebAssembly, where there is no zlib to link: a stream is inflated by
 * one call, from all of its bytes to all of its room. */
#ifndef ACDF_WEB_ZLIB_H
#define ACDF_WEB_ZLIB_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef unsigned char Bytef;
typedef unsigned int uInt;

enum { Z_OK = 0, Z_STREAM_END = 1, Z_DATA_ERROR = -3, Z_BUF_ERROR = -5, Z_NO_FLUSH = 0 };

typedef struct z_stream_s {
    Bytef* next_in;
    uInt avail_in;
    Bytef* next_out;
    uInt avail_out;
} z_stream;

#define inflateInit(stream) ((void)(stream), Z_OK)
#define inflateEnd(stream) ((void)(stream), Z_OK)

/* Inflates a zlib stream (RFC 1950). Z_STREAM_END; or Z_BUF_ERROR where the room is full, Z_DATA_ERROR where the
 * stream is damaged or ends early. The counts of bytes read and written are set as by zlib. */
int inflate(z_stream* stream, int flush);

/* CRC-32 of `size` bytes after those whose CRC-32 is `crc`. */
unsigned long crc32_z(unsigned long crc, const Bytef* bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
