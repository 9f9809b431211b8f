// Which share of the samples a file takes beside its MIS partner.
#pragma once

namespace acdf::compress {

/// The share in (0.02, 0.98) of which `moment(share)`, which is convex, is least: by so many steps of
/// golden-section search.
template <class Moment>
float least_share(const Moment& moment, int steps) {
    constexpr double golden = 0.6180339887498949;
    double low = 0.02, high = 0.98;
    for (int step = 0; step < steps; ++step) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (moment(left) < moment(right)) high = right;
        else low = left;
    }
    return static_cast<float>(0.5 * (low + high));
}

} // namespace acdf::compress
