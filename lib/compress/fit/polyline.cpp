#include "compress/fit/polyline.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

struct Span {
    std::uint32_t first = 0, last = 0; // points first < last
    std::uint32_t worst = 0;           // the point between them that deviates most; 0 if there is none
    double deviation = 0.0;

    bool operator<(const Span& other) const { // the queue serves the largest deviation, then the lowest index
        return deviation != other.deviation ? deviation < other.deviation : first > other.first;
    }
};

Span measure_span(const std::vector<double>& x, const std::vector<double>& y, std::uint32_t first,
                  std::uint32_t last) {
    Span span{first, last, 0, 0.0};
    const double slope = (y[last] - y[first]) / (x[last] - x[first]);
    for (std::uint32_t i = first + 1; i < last; ++i) {
        const double deviation = std::abs(y[i] - (y[first] + slope * (x[i] - x[first])));
        if (deviation > span.deviation) {
            span.deviation = deviation;
            span.worst = i;
        }
    }
    return span;
}

} // namespace

std::vector<std::uint32_t> douglas_peucker(const std::vector<double>& x, const std::vector<double>& y,
                                           std::uint32_t segments, double epsilon) {
    std::vector<std::uint32_t> knots;
    std::priority_queue<Span> queue;
    queue.push(measure_span(x, y, 0, static_cast<std::uint32_t>(x.size() - 1)));
    while (knots.size() + 1 < segments) {
        const Span span = queue.top();
        if (span.worst == 0 || span.deviation <= epsilon) break;
        queue.pop();
        knots.push_back(span.worst);
        queue.push(measure_span(x, y, span.first, span.worst));
        queue.push(measure_span(x, y, span.worst, span.last));
    }
    std::sort(knots.begin(), knots.end());
    return knots;
}

} // namespace acdf::compress
