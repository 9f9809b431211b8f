#include "build/builder/guard.h"

#include "build/errors.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

namespace acdf::builder {
namespace {

Status status_of(ErrorCode code, const char* message) noexcept {
    Status status;
    status.code = code;
    std::strncpy(status.message, message, sizeof status.message - 1);
    for (char& c : status.message)
        if (c == '\n' || c == '\r') c = ' ';
    return status;
}

} // namespace

void Gate::tell(double share, const char* what) {
    const std::lock_guard lock(mutex_);
    if (failed_) throw build::CallbackFailed();
    if (cancelled_) throw build::Cancelled();
    if (!progress_) return;
    told_ = std::clamp(share, told_, 1.0);
    failed_ = true; // unless it returns
    bool go_on = false;
    try {
        go_on = progress_(told_, what);
    } catch (...) {
        throw build::CallbackFailed();
    }
    failed_ = false;
    cancelled_ = !go_on;
    if (cancelled_) throw build::Cancelled();
}

build::Progress Gate::part(double begin, double width) {
    return [this, begin, width](double share, const char* what) { tell(begin + width * share, what); };
}

void require(bool holds, const char* what) {
    if (!holds) throw build::OptionError(what);
}

Status current_status() noexcept {
    try {
        throw;
    } catch (const Status& status) {
        return status;
    } catch (const build::OptionError& error) {
        return status_of(ErrorCode::invalid_argument, error.what());
    } catch (const build::NoEnergy& error) {
        return status_of(ErrorCode::no_energy, error.what());
    } catch (const std::invalid_argument& error) {
        return status_of(ErrorCode::bad_source, error.what());
    } catch (const build::Cancelled&) {
        return status_of(ErrorCode::cancelled, "cancelled by the caller");
    } catch (const build::CallbackFailed&) {
        return status_of(ErrorCode::callback_failed, "a callback of the caller threw an exception or gave up");
    } catch (const std::bad_alloc&) {
        return status_of(ErrorCode::out_of_memory, "there is not enough memory");
    } catch (const std::length_error&) {
        return status_of(ErrorCode::out_of_memory, "there is not enough memory");
    } catch (const std::runtime_error& error) {
        return status_of(ErrorCode::out_of_reach, error.what());
    } catch (const std::exception& error) {
        return status_of(ErrorCode::internal, error.what());
    } catch (...) {
        return status_of(ErrorCode::internal, "an unknown exception");
    }
}

} // namespace acdf::builder
