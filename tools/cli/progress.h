// A progress bar for whatever takes longer than a second.
#pragma once

#include "build/progress.h"

#include <memory>
#include <string>

namespace acdf::tools {

/// ", 12 s left", from how much is done after `elapsed` seconds; empty while that is not known yet.
std::string time_left(double fraction, double elapsed);

/// Shows progress on stderr, from the second second on, where that is a terminal; does nothing elsewhere or where
/// `quiet`. It prints how long the rest will take, never runs backwards, and is wiped when the object ends.
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
