// A progress bar for whatever takes longer than a second.
#pragma once

#include <functional>
#include <memory>

namespace acdf::tools {

/// Called by long work with the share that is done, in [0, 1], and what is being done ("fitting"). May be called
/// from several threads, and as often as is convenient.
using Progress = std::function<void(double fraction, const char* what)>;

/// Draws on stderr, from the second second on, where that is a terminal; does nothing elsewhere or where `quiet`.
/// The bar is wiped when the object ends.
class ProgressBar {
public:
    explicit ProgressBar(bool quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Valid while the bar lives.
    Progress callback();

private:
    struct State;
    std::unique_ptr<State> state_; // null: silent
};

} // namespace acdf::tools
