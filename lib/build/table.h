// From an array of numbers to the bytes of a table file: bins, fit, trees, file, and its exact accuracy.
#pragma once

#include "build/accuracy/table.h"
#include "build/array.h"
#include "build/progress.h"
#include "compress/fit/fit.h"
#include "compress/grid.h"
#include "compress/partner.h"
#include "compress/store/store.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace acdf::build {

/// What `acdf table` was asked for, beside the array.
struct TableOptions {
    std::uint32_t indexed = 0;                     ///< leading axes that the caller of a sample chooses
    std::vector<std::string> names;                ///< one an axis; empty: x0, x1, ...
    std::vector<std::pair<double, double>> ranges; ///< one an axis: coordinates of its ends; empty: 0 to its length
    std::uint32_t cells = 4096;                    ///< a bin, on average, where those are the goal
    compress::Goal goal;                           ///< cells: see above
    double max_weight = 0.0;                       ///< the largest f/p over its mean, in any bin; 0: no bound
    compress::Partner mis;                         ///< ACDF_PARTNER_TABLE or none
    const Array* other = nullptr;                  ///< that table; it must outlive the build
    std::string other_name, other_sha256;          ///< where it comes from
    AcdfCodec codec = ACDF_CODEC_NONE;
};

struct Table {
    std::vector<std::uint8_t> bytes; ///< the whole file
    TableAccuracy accuracy;          ///< of the stored pdfs, after quantization
    double total = 0.0;
};

/// One grid a bin: the values of the array under each combination of its first `indexed` axes, each sampled axis of
/// length 1. `array` must outlive them.
std::vector<compress::Grid> table_grids(const Array& array, std::uint32_t indexed);

/// Throws std::invalid_argument where options and array do not fit each other (which says how), where the array has
/// no energy or its integral is not a number that the format holds; std::runtime_error where the goal is out of
/// reach.
Table build_table(const Array& array, const std::string& source_name, const std::string& source_sha256,
                  const TableOptions& options, const Progress& progress = {});

} // namespace acdf::build
