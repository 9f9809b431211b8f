// Environments with groups of cells (acdf/groups.h), which large files alone have.
#pragma once

#include "memory.h"
#include "reader/tables/cells.h"
#include "reader/tables/groups.h"

#include <cstddef>
#include <cstdint>

namespace acdf_test {

/// An environment with groups instead of the tables that it has, or without any where there can be none.
struct Grouped {
    AcdfEnvironment data;

    /// In at most some bytes; `least`: in as few as can be, by groups of as many cells as there may be.
    Grouped(const AcdfEnvironment& from, std::uint32_t tree_units, std::size_t most_bytes, bool least)
        : data(from) {
        const acdf::TreeSurvey survey(data, tree_units);
        data.cells = nullptr;
        data.groups = nullptr;
        for (std::size_t most = least ? most_bytes / 1024 : most_bytes; !data.groups && most <= most_bytes;
             most += most / 16 + 1)
            data.groups = acdf::make_groups(data, survey, most, {}, block_);
    }
    ~Grouped() { acdf::give_block({}, block_); }
    Grouped(const Grouped&) = delete;
    Grouped& operator=(const Grouped&) = delete;

private:
    AcdfBlock block_ = {};
};

} // namespace acdf_test
