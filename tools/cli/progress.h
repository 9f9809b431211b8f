// A progress bar for whatever takes longer than a second.
#pragma once

#include "build/progress.h"

#include <memory>

namespace acdf::tools {

/// Draws on stderr, from the second second on, where that is a terminal; does nothing elsewhere or where `quiet`.
/// The bar is wiped when the object ends.
class ProgressBar {
public:
    explicit ProgressBar(bool quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Valid while the bar lives.
    build::Progress callback();

private:
    struct State;
    std::unique_ptr<State> state_; // null: silent
};

} // namespace acdf::tools
