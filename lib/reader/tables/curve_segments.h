// The segments of a curve of a tree, one after the other.
#pragma once

#include <acdf/tree.h>

#include <cstdint>

namespace acdf {

/// A segment of a curve as it is stored.
struct CurveSegment {
    std::uint32_t from, to;    ///< cumulative values
    std::uint32_t first, last; ///< positions
};

/// Those of a curve that divides positions [first, last) of its axis. What is the same for all is kept by value: it
/// is not to be read again after each store.
class CurveSegments {
public:
    CurveSegments(const AcdfCurve& curve, std::uint32_t first, std::uint32_t last)
        : curve_(curve), cumulative_code_(ACDF_CURVE_CUMULATIVE_CODE(curve.header)),
          position_code_(ACDF_CURVE_POSITION_CODE(curve.header)), maximum_(acdf_curve_maximum(&curve)), end_(last),
          origin_(position_code_ == 0 ? first : 0), border_{0, first} {}
    std::uint32_t maximum() const { return maximum_; }
    /// The number of the next one.
    std::uint32_t number() const { return next_; }
    /// The distance to the child of the next one; 0: it ends.
    std::uint32_t link() const { return acdf_curve_link(&curve_, next_); }
    CurveSegment next() {
        const Border from = border_;
        ++next_;
        border_ = next_ < curve_.segments ? border(next_) : Border{maximum_, end_};
        return {from.cumulative, border_.cumulative, from.position, border_.position};
    }

private:
    struct Border {
        std::uint32_t cumulative, position;
    };
    Border border(std::uint32_t i) const {
        return {acdf_load(curve_.cumulative, i - 1, cumulative_code_),
                origin_ + acdf_load(curve_.positions, i - 1, position_code_)};
    }

    AcdfCurve curve_;
    std::uint32_t cumulative_code_, position_code_, maximum_;
    std::uint32_t next_ = 0, end_, origin_;
    Border border_;
};

} // namespace acdf
