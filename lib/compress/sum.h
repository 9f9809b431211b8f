// A sum whose result does not depend on the order of its terms beyond rounding of the last bits.
#pragma once

#include <cmath>

namespace acdf::compress {

/// Compensated summation (Neumaier 1974): the error stays near 1e-16 of the sum of magnitudes, however many
/// terms are added.
class Sum {
public:
    void add(double term) {
        const double total = sum_ + term;
        compensation_ += std::abs(sum_) >= std::abs(term) ? (sum_ - total) + term : (term - total) + sum_;
        sum_ = total;
    }
    double value() const { return sum_ + compensation_; }

private:
    double sum_ = 0.0, compensation_ = 0.0;
};

/// The same of terms that are themselves known to a few bits less than that: so many at a time are added plainly,
/// which waits less.
class PlainerSum {
public:
    void add(double term) {
        part_ += term;
        if (++count_ == kTogether) fold();
    }
    double value() const {
        Sum all = sum_;
        all.add(part_);
        return all.value();
    }

private:
    static constexpr unsigned kTogether = 64;

    void fold() {
        sum_.add(part_);
        part_ = 0.0;
        count_ = 0;
    }

    double part_ = 0.0;
    unsigned count_ = 0;
    Sum sum_;
};

} // namespace acdf::compress
