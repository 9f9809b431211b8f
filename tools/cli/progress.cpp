#include "tools/cli/progress.h"

#include "tools/cli/messages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string>

#include <unistd.h>

namespace acdf::tools {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto patience = std::chrono::seconds(1);
constexpr auto redraw_interval = std::chrono::milliseconds(100);
constexpr int bar_width = 30;

void draw(double fraction, const char* what, double elapsed) {
    const int full = static_cast<int>(fraction * bar_width);
    std::fprintf(to_person(), "\r\033[K%s%s %3d%% %s%s", std::string(static_cast<std::size_t>(full), '#').c_str(),
                 std::string(static_cast<std::size_t>(bar_width - full), '.').c_str(),
                 static_cast<int>(100.0 * fraction), what, time_left(fraction, elapsed).c_str());
    std::fflush(to_person());
}

} // namespace

std::string time_left(double fraction, double elapsed) {
    if (!(fraction > 0.02 && fraction <= 1.0)) return "";
    const double left = std::ceil(elapsed * (1.0 - fraction) / fraction);
    if (left > 359999.0) return "";
    const auto seconds = static_cast<int>(left);
    char text[48];
    if (seconds < 60) std::snprintf(text, sizeof text, ", %d s left", seconds);
    else if (seconds < 3600) std::snprintf(text, sizeof text, ", %d:%02d min left", seconds / 60, seconds % 60);
    else std::snprintf(text, sizeof text, ", %d:%02d h left", seconds / 3600, seconds / 60 % 60);
    return text;
}

struct ProgressBar::State {
    std::mutex mutex;
    Clock::time_point start = Clock::now();
    Clock::time_point drawn = {};
    double furthest = 0.0; // stages guess their shares; the bar never runs back
    bool visible = false;

    void report(double fraction, const char* what) {
        const std::unique_lock lock(mutex, std::try_to_lock);
        if (!lock) return; // another thread prints it: nobody waits for a progress bar
        furthest = std::max(furthest, std::clamp(fraction, 0.0, 1.0));
        const Clock::time_point now = Clock::now();
        if (now - start < patience || now - drawn < redraw_interval) return;
        drawn = now;
        visible = true;
        draw(furthest, what, std::chrono::duration<double>(now - start).count());
    }
};

ProgressBar::ProgressBar(bool quiet) {
    if (!quiet && isatty(STDERR_FILENO)) state_ = std::make_unique<State>();
}

ProgressBar::~ProgressBar() {
    if (state_ && state_->visible) std::fputs("\r\033[K", to_person());
}

build::Progress ProgressBar::callback() {
    if (!state_) return [](double, const char*) {};
    return [state = state_.get()](double fraction, const char* what) { state->report(fraction, what); };
}

} // namespace acdf::tools
