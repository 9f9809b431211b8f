/* Which tile holds a square: a grid whose entries are tiles, or name blocks of 4 x 4 finer ones, whose entries may
 * name blocks again. Part of the runtime tables of the fast shape (acdf/fast.h); flat words without pointers. Its
 * results are those of the traversal of the splits. */
#ifndef ACDF_TILE_BLOCKS_H
#define ACDF_TILE_BLOCKS_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_TILE_BLOCK_LEVELS = 3 };

/* Offsets are in words, from the start of all tables. */
typedef struct AcdfTileBlocks {
    uint32_t grid;     /* u16: a tile with ACDF_TILE_FLAG, or a block */
    uint32_t blocks;   /* u16, 16 of each block: the same; at the last level a split of the file from which to
                          traverse in   place of a block */
    uint32_t levels;   /* of blocks, 1 to ACDF_TILE_BLOCK_LEVELS */
    uint32_t shift[2]; /* bits of positions that are finer than the grid */
    uint32_t fine[ACDF_TILE_BLOCK_LEVELS][2]; /* than the blocks of each level */
    uint32_t bits0; /* the grid has 2^bits0 entries along axis 0, which are next to each other */
} AcdfTileBlocks;

/* The tile of a square, or the split to traverse from. No branch on the data: where the tile is known already, some
 * block is looked at in vain. */
ACDF_INLINE uint32_t acdf_tile_block_at(const uint32_t* words, const AcdfTileBlocks* tables,
                                        const uint32_t* square) {
    const uint16_t* grid = (const uint16_t*)(const void*)(words + tables->grid);
    const uint16_t* blocks = (const uint16_t*)(const void*)(words + tables->blocks);
    uint32_t node = grid[(square[1] >> tables->shift[1] << tables->bits0) + (square[0] >> tables->shift[0])], level;
    for (level = 0; level < tables->levels; ++level) {
        const uint32_t* fine = tables->fine[level];
        const uint32_t inside = (square[1] >> fine[1] & 3u) * 4u + (square[0] >> fine[0] & 3u);
        const uint32_t told = 0u - (node >> 15);
        const uint32_t finer = blocks[16u * (node & ~told) + inside];
        node = finer ^ ((finer ^ node) & told);
    }
    return node;
}

#ifdef __cplusplus
}
#endif
#endif
