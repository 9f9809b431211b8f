// Sources that are in the library's own terms already: what programs that link all of lib/ build from.
#pragma once

#include "build/array.h"
#include "build/probe_rows.h"
#include "build/progress.h"
#include "build/reflectance.h"
#include "compress/target.h"

#include <acdf/builder.h>

#include <optional>
#include <string>
#include <utility>

namespace acdf::builder {

/// What a Target holds.
struct Target::Data {
    compress::Target grid;
    compress::TargetOptions options;
    BadTexels bad;
    std::string projection; ///< its name, where pixels told it
};

/// The function that is fitted. `target` is not empty, and the reference lives as long as a copy of it.
const compress::Target& grid_of(const Target& target);

/// A target in the library's terms. Throws build::NoEnergy.
Target target_of(compress::Target grid, const TargetOptions& options, const BadTexels& bad = {},
                 const std::string& projection = {});

compress::TargetOptions internal(const TargetOptions& options);

/// Rows of a probe on their way into a target.
class TargetRows : public build::ProbeRows {
public:
    explicit TargetRows(const TargetOptions& options, build::Progress progress = {})
        : options_(options), progress_(std::move(progress)) {}
    void begin(int width, int height) override;
    void take(int first, int count, const float* rgb) override;
    /// Once, after all rows. Throws build::NoEnergy.
    Target finish(const BadTexels& bad = {}, const std::string& projection = {});

private:
    TargetOptions options_;
    build::Progress progress_;
    int height_ = 0;
    std::optional<compress::EnvironmentTarget> rows_;
};

/// `brdf` must outlive what is made.
Brdf described(const build::Brdf& brdf);

/// The table of numbers that are floats already; `bad` says what they were.
Status table(const build::Array& array, const BadNumbers& bad, const TableOptions& options, Table& result,
             const Control& control = {}) noexcept;

} // namespace acdf::builder
