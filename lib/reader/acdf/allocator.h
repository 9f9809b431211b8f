/* Where the memory of open files comes from: the C library, or the caller. Plain C99 and C++17. */
#ifndef ACDF_ALLOCATOR_H
#define ACDF_ALLOCATOR_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* All null: the C library. Both functions are called by the thread that opens or closes a file, `context` is handed
 * to them. */
typedef struct AcdfAllocator {
    /* `bytes` > 0, a multiple of `alignment`, which is a power of two, at most 64. Null where there is no memory.
     */
    void* (*allocate)(void* context, size_t bytes, size_t alignment);
    /* What `allocate` returned, and how much it was asked for. */
    void (*release)(void* context, void* block, size_t bytes);
    void* context;
} AcdfAllocator;

/* A piece of it. */
typedef struct AcdfBlock {
    void* data;
    size_t bytes;
} AcdfBlock;

#ifdef __cplusplus
}
#endif
#endif
