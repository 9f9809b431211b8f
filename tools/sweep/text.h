// The rows of a sweep as text for programs: sweep.csv and sweep.json (docs/sweep.schema.json).
#pragma once

#include "tools/sweep/sweep.h"

#include <string>
#include <variant>
#include <vector>

namespace acdf::tools {

/// What a column holds of a row. A number is rounded to nine digits here, so that it is the same in all outputs;
/// infinite: biased; kUnknown: does not apply.
using SweepValue = std::variant<std::string, std::uint64_t, double>;

struct SweepColumn {
    const char* name;
    const char* heading; ///< for people; null: not in the report's table
    bool timing;         ///< differs from run to run
    SweepValue (*value)(const Sweep& sweep, const SweepRow& row);
};

/// Those of a sweep: without times where it is not timed.
std::vector<SweepColumn> columns_of(const Sweep& sweep);

/// As it is in the CSV, but for quotes: "" where unknown, "inf" where infinite.
std::string exact_text(const SweepValue& value);

/// Quotes around what needs them (RFC 4180), lines end in LF.
std::string sweep_csv(const Sweep& sweep);
/// null where unknown or infinite (then "biased" is true).
std::string sweep_json(const Sweep& sweep);

} // namespace acdf::tools
