/* Shading points of a local environment for shaders: what serves a normal, as acdf/local.h says, in floats,
 * over the words of acdf/shader/tree.h. One text for processors and for shaders of every language
 * (acdf/shader/dialect.h).
 */
#ifndef ACDF_SHADER_POINT_H
#define ACDF_SHADER_POINT_H

#include <acdf/shader/tree.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what serves a normal --------------------------------------------------------------------------- */

/* Made once for a shading point, it serves all samples there. Up to three rows are mixed. */
ACDF_STRUCT_BEGIN(AcdfShaderPoint)
ACDF_FIELD(AcdfWalkMixture, mix)
ACDF_FIELD(ACDF_F32, sum)    /* of all weights */
ACDF_FIELD(ACDF_F32, cosine) /* share of the cosine lobe */
ACDF_FIELD(ACDF_F32, x)      /* the unit normal */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_STRUCT_END(AcdfShaderPoint)

/* What samples from the whole tree at a link. */
ACDF_FN1(AcdfShaderPoint, acdf_point_of_tree, ACDF_U32, root) {
    ACDF_VAR(AcdfShaderPoint, here);
    here.mix = acdf_mixture_below(root, 1.0f);
    here.sum = 1.0f;
    here.cosine = 0.0f;
    here.x = 0.0f;
    here.y = 0.0f;
    here.z = 1.0f;
    return here;
}

/* What serves all normals. */
ACDF_FN1(AcdfShaderPoint, acdf_point_anywhere, ACDF_TABLES, tables) {
    return acdf_point_of_tree(ACDF_WORD(tables, ACDF_WALK_ENVIRONMENT));
}

/* The number of the corner |x|, |y|, |z| of an octahedron whose edges are divided by n, as acdf_octahedral_corner
 * counts; signs: bit i: axis i is negative. */
ACDF_FN5(ACDF_U32, acdf_corner_of, ACDF_U32, n, ACDF_U32, ax, ACDF_U32, ay, ACDF_U32, az, ACDF_U32, signs) {
    ACDF_LET(ACDF_U32, west) = ACDF_SELECT(ax != 0u, signs & 1u, 0u);
    ACDF_LET(ACDF_U32, back) = ACDF_SELECT(ay != 0u, (signs >> 1u) & 1u, 0u);
    ACDF_LET(ACDF_U32, south) = ACDF_SELECT(az != 0u, (signs >> 2u) & 1u, 0u);
    ACDF_LET(ACDF_U32, r) = n - az;
    ACDF_LET(ACDF_U32, upper) = ACDF_SELECT(r != 0u, 1u + 2u * r * (r - 1u), 0u);
    ACDF_LET(ACDF_U32, lower) = 4u * n * n + 1u - 2u * r * (r + 1u);
    ACDF_LET(ACDF_U32, quarter) = (3u * back) ^ west;
    return ACDF_SELECT(south != 0u, lower, upper) + quarter * r + ay + (quarter & 1u) * (ax - ay);
}

/* Adds the row of a bin to a mixture; a bin that is not stored makes it the environment's. */
ACDF_FN4(AcdfShaderPoint, acdf_point_with, ACDF_TABLES, tables, AcdfShaderPoint, given, ACDF_U32, bin, ACDF_F32,
         weight) {
    ACDF_VAR(AcdfShaderPoint, here) = given;
    ACDF_LET(ACDF_U32, at) = ACDF_WORD(tables, ACDF_WALK_BINS) + 2u * bin;
    ACDF_LET(ACDF_U32, row) = ACDF_WORD(tables, at);
    ACDF_LET(ACDF_F32, part) = weight * acdf_word_as_float(tables, at + 1u);
    if (row == ACDF_WALK_NONE) {
        here.mix.root = ACDF_WORD(tables, ACDF_WALK_ENVIRONMENT);
    } else {
        here.mix = acdf_mixture_with(here.mix, row, part);
    }
    return here;
}

/* Up to three bins and their weights, which may be 0. */
ACDF_STRUCT_BEGIN(AcdfShaderBins)
ACDF_FIELD(ACDF_U32, bin0)
ACDF_FIELD(ACDF_U32, bin1)
ACDF_FIELD(ACDF_U32, bin2)
ACDF_FIELD(ACDF_F32, weight0)
ACDF_FIELD(ACDF_F32, weight1)
ACDF_FIELD(ACDF_F32, weight2)
ACDF_STRUCT_END(AcdfShaderBins)

/* Those of the triangle of an octahedron that holds a normal of any length: acdf_octahedral_bins. */
ACDF_FN4(AcdfShaderBins, acdf_bins_of_triangle, ACDF_U32, n, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(ACDF_U32, signs) =
        ACDF_SELECT(x < 0.0f, 1u, 0u) + ACDF_SELECT(y < 0.0f, 2u, 0u) + ACDF_SELECT(z < 0.0f, 4u, 0u);
    ACDF_LET(ACDF_F32, edge) = ACDF_TO_F32(n) / (ACDF_ABS(x) + ACDF_ABS(y) + ACDF_ABS(z));
    ACDF_LET(ACDF_F32, a) = ACDF_ABS(x) * edge;
    ACDF_LET(ACDF_F32, b) = ACDF_ABS(y) * edge;
    ACDF_LET(ACDF_F32, c) = ACDF_ABS(z) * edge;
    ACDF_LET(ACDF_U32, a0) = ACDF_MIN(ACDF_TO_U32(a), n);
    ACDF_LET(ACDF_U32, b0) = ACDF_MIN(ACDF_TO_U32(b), n - a0);
    ACDF_LET(ACDF_U32, c0) = ACDF_MIN(ACDF_TO_U32(c), n - a0 - b0);
    ACDF_LET(ACDF_U32, over) =
        n - a0 - b0 - c0; /* 0 to 2 but for rounding: at a corner, or a triangle up or down */
    ACDF_LET(ACDF_U32, down) = over >> 1u;
    ACDF_LET(ACDF_F32, turned) = ACDF_TO_F32(down);
    ACDF_LET(ACDF_U32, one) = ACDF_SELECT(over == 1u || over == 2u, 1u, 0u);
    ACDF_LET(ACDF_U32, same) =
        ACDF_SELECT(over == 0u, 0u, down); /* what a corner has more on the axes of the others */
    ACDF_LET(ACDF_U32, mine) = ACDF_SELECT(one != 0u, 1u - down, same);
    ACDF_VAR(AcdfShaderBins, bins);
    bins.bin0 = acdf_corner_of(n, a0 + mine, b0 + same, c0 + same, signs);
    bins.bin1 = acdf_corner_of(n, a0 + same, b0 + mine, c0 + same, signs);
    bins.bin2 = acdf_corner_of(n, a0 + same, b0 + same, c0 + mine, signs);
    ACDF_LET(ACDF_F32, a1) = ACDF_TO_F32(a0);
    ACDF_LET(ACDF_F32, b1) = ACDF_TO_F32(b0);
    ACDF_LET(ACDF_F32, c1) = ACDF_TO_F32(c0);
    ACDF_LET(ACDF_F32, m) = ACDF_TO_F32(mine);
    ACDF_LET(ACDF_F32, s) = ACDF_TO_F32(same);
    ACDF_LET(ACDF_F32, wa) = ACDF_SELECT(one != 0u, ACDF_ABS(turned - (a - a1)), 1.0f);
    ACDF_LET(ACDF_F32, wb) = ACDF_SELECT(one != 0u, ACDF_ABS(turned - (b - b1)), 0.0f);
    ACDF_LET(ACDF_F32, wc) = ACDF_SELECT(one != 0u, ACDF_ABS(turned - (c - c1)), 0.0f);
    bins.weight0 = wa * ACDF_SQRT((a1 + m) * (a1 + m) + (b1 + s) * (b1 + s) + (c1 + s) * (c1 + s));
    bins.weight1 = wb * ACDF_SQRT((a1 + s) * (a1 + s) + (b1 + m) * (b1 + m) + (c1 + s) * (c1 + s));
    bins.weight2 = wc * ACDF_SQRT((a1 + s) * (a1 + s) + (b1 + s) * (b1 + s) + (c1 + m) * (c1 + m));
    return bins;
}

/* A mixture of the rows of bins. */
ACDF_FN2(AcdfShaderPoint, acdf_point_of_rows, ACDF_TABLES, tables, AcdfShaderBins, bins) {
    ACDF_LET(ACDF_U32, root) = ACDF_WORD(tables, ACDF_WALK_MIXTURE);
    ACDF_VAR(AcdfShaderPoint, here) = acdf_point_of_tree(root);
    here.mix.weight0 = 0.0f;
    here = acdf_point_with(tables, here, bins.bin0, bins.weight0);
    if (bins.weight1 > 0.0f) {
        here = acdf_point_with(tables, here, bins.bin1, bins.weight1);
    }
    if (bins.weight2 > 0.0f) {
        here = acdf_point_with(tables, here, bins.bin2, bins.weight2);
    }
    if (here.mix.root != root) { /* one of them is not stored */
        return acdf_point_of_tree(here.mix.root);
    }
    here.sum = acdf_mixture_weight(here.mix);
    if (!(here.sum > 0.0f)) {
        here.mix.root = ACDF_WALK_NONE;
    }
    return here;
}

/* What serves a normal of any length; nothing serves one that is zero, NaN or infinite. */
ACDF_FN4(AcdfShaderPoint, acdf_point_at, ACDF_TABLES, tables, ACDF_F32, nx, ACDF_F32, ny, ACDF_F32, nz) {
    ACDF_LET(ACDF_F32, most) = ACDF_MAX(ACDF_ABS(nx), ACDF_MAX(ACDF_ABS(ny), ACDF_ABS(nz)));
    if (ACDF_WORD(tables, ACDF_WALK_BIN_COUNT) == 0u) {
        return acdf_point_anywhere(tables);
    }
    if (!(most > 0.0f && ACDF_ABS(nx) + ACDF_ABS(ny) + ACDF_ABS(nz) < 3e38f)) {
        return acdf_point_of_tree(ACDF_WALK_NONE);
    }
    ACDF_LET(ACDF_F32, x0) = nx / most; /* squares of which are floats */
    ACDF_LET(ACDF_F32, y0) = ny / most;
    ACDF_LET(ACDF_F32, z0) = nz / most;
    ACDF_LET(ACDF_F32, length) = ACDF_SQRT(x0 * x0 + y0 * y0 + z0 * z0);
    ACDF_LET(ACDF_F32, x) = x0 / length;
    ACDF_LET(ACDF_F32, y) = y0 / length;
    ACDF_LET(ACDF_F32, z) = z0 / length;
    ACDF_LET(ACDF_U32, n) = ACDF_WORD(tables, ACDF_WALK_SUBDIVISIONS);
    ACDF_VAR(AcdfShaderPoint, here) =
        acdf_point_of_rows(tables, acdf_bins_of_triangle(n, x0, y0, z0)); /* edges stay where they are */
    here.cosine = acdf_word_as_float(tables, ACDF_WALK_COSINE);
    here.x = x;
    here.y = y;
    here.z = z;
    return here;
}

#ifdef __cplusplus
}
#endif
#endif
