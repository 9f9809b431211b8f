// From the options of the public library to those of its parts, checked.
#pragma once

#include "build/brdf.h"
#include "build/environment.h"
#include "build/indexed/environment.h"
#include "build/local.h"
#include "build/table.h"

#include <acdf/builder.h>

namespace acdf::builder {

compress::TargetOptions internal(const TargetOptions& options);
build::EnvironmentOptions internal(const EnvironmentOptions& options);
build::LocalOptions internal(const LocalOptions& options);
build::BrdfFileOptions internal(const BrdfOptions& options);
build::IndexedOptions internal(const IndexedOptions& options);
build::TableOptions internal(const TableOptions& options, std::uint64_t bins);

// Throw build::OptionError for what is out of range or contradicts itself.
void check(const TargetOptions& options);
void check(const EnvironmentOptions& options);
void check(const LocalOptions& options);
void check(const BrdfOptions& options);
void check(const TableOptions& options);
void check(const IndexedOptions& options, std::size_t maps);

} // namespace acdf::builder
