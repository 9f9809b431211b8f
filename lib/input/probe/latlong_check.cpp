#include "input/probe/latlong_check.h"

#include "input/probe/blank.h"
#include "input/probe/seams.h"

#include <algorithm>
#include <cstdint>

namespace acdf::input {
namespace {

constexpr int kLeastRowsOfDiscs = 32, kLeastRowsOfSides = 128; // what fewer texels show proves nothing
constexpr int kMostRows = 128;
constexpr char kInsist[] = "; if it is a lat-long map, set --projection latlong";

} // namespace

LatlongCheck::LatlongCheck(int width, int height) : height_(height), rows_(width, std::min(height, kMostRows)) {}

/// The first and the last, and others at equal distances.
int LatlongCheck::row_of(int kept) const {
    return rows_.height() < 2 ? 0 : static_cast<int>(std::int64_t{kept} * (height_ - 1) / (rows_.height() - 1));
}

void LatlongCheck::take(int first, int count, const float* rgb) {
    for (int kept = 0; kept < rows_.height(); ++kept) {
        const int row = row_of(kept);
        if (row >= first && row < first + count)
            rows_.set_row(kept, rgb + 3 * static_cast<std::size_t>(row - first) *
                                          static_cast<std::size_t>(rows_.width()));
    }
}

std::string LatlongCheck::objection() const {
    if (height_ >= kLeastRowsOfDiscs && is_pair_of_discs(rows_))
        return std::string("shows two discs with black around them, as from a camera with two fisheye lenses, and "
                           "is not a lat-long map; stitch them into one") +
               kInsist;
    if (height_ >= kLeastRowsOfSides && sides_do_not_meet(rows_))
        return std::string(
                   "has the shape of a lat-long map, but its left and right sides do not meet, as those of the "
                   "whole sphere do") +
               kInsist;
    return {};
}

} // namespace acdf::input
