// Turns results of lib/build into failures of the program, and its progress into a progress bar.
#pragma once

#include "build/progress.h"
#include "tools/commands.h"

#include <acdf/builder.h>

#include <new>
#include <stdexcept>
#include <string>

namespace acdf::tools {

/// Reports to `progress`, and never cancels.
inline builder::Control told(const build::Progress& progress) {
    builder::Control control;
    if (progress)
        control.progress = [progress](double share, const char* what) {
            progress(share, what);
            return true;
        };
    return control;
}

/// Throws std::runtime_error where a goal is out of reach, std::bad_alloc, and std::invalid_argument for all else.
inline void throw_unless_built(const builder::Status& status) {
    switch (status.code) {
    case builder::ErrorCode::none:
        return;
    case builder::ErrorCode::out_of_reach:
        throw std::runtime_error(status.message);
    case builder::ErrorCode::out_of_memory:
        throw std::bad_alloc();
    default:
        throw std::invalid_argument(status.message);
    }
}

/// Throws Failure, which names `source`, or std::bad_alloc.
inline void require_built(const std::string& source, const builder::Status& status) {
    if (status.code == builder::ErrorCode::out_of_memory) throw std::bad_alloc();
    if (!status.ok()) throw Failure(source + ": " + status.message);
}

} // namespace acdf::tools
