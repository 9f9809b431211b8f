/* Files of the fits `cdf`, `pdf` and `uniform`, as the paper has them (SPEC.md §7): a program that opens them hands
 * the reader what samples them.
 *
 *   AcdfLoadOptions options = {0};
 *   options.curves = acdf_curves();
 *   AcdfFile* file = acdf_open_with("probe.acdf", &options, &error);
 *
 * In C++: acdf::File::open("probe.acdf", file, acdf::with_curves()). Views are used as those of other files are,
 * but not on a GPU. */
#ifndef ACDF_CURVES_CURVES_H
#define ACDF_CURVES_CURVES_H

#include <acdf/acdf.h>

#ifdef __cplusplus
#include <acdf/reader.h>
extern "C" {
#endif

/* What reads and samples files of curves, for AcdfLoadOptions::curves and acdf::LoadOptions::curves. It is
 * constant: any number of threads may use it. */
const AcdfCurves* acdf_curves(void);

/* Chunk TREE of an open file, of which `units` becomes the size in units of two bytes, valid until the file is
 * closed. Null, and 0 units, where the file has none. acdf/curves/tree.h reads it. */
const uint8_t* acdf_curves_tree(const AcdfFile* file, uint32_t* units);

#ifdef __cplusplus
}

namespace acdf {

/// Options by which files of curves are read, too.
inline LoadOptions with_curves(LoadOptions options = {}) noexcept {
    options.curves = acdf_curves();
    return options;
}

} // namespace acdf
#endif
#endif
