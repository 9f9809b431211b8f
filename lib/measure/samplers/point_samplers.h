// What makes a LightSampler of a class that samples: its tables, and one PointSampler a thread.
#pragma once

#include "measure/samplers/light_sampler.h"

#include <algorithm>
#include <utility>

namespace acdf::measure {

/// The largest random number that is not 1 when it is rounded to float.
inline double below_one(double u) { return std::min(u, 1.0 - 0x1p-24); }

/// A LightSampler for what samples alike at all points. `Table` has sample(u0, u1), pdf(direction) and bytes().
template <class Table>
class SameEverywhere : public LightSampler {
public:
    template <class... Arguments>
    explicit SameEverywhere(Arguments&&... arguments) : table_(std::forward<Arguments>(arguments)...) {}

    std::unique_ptr<PointSampler> point_sampler() const override { return std::make_unique<Point>(table_); }
    std::uint64_t bytes() const override { return table_.bytes(); }
    const Table& table() const { return table_; }

private:
    class Point final : public PointSampler {
    public:
        explicit Point(const Table& table) : table_(table) {}
        void move_to(const ShadingPoint&) override {}
        AcdfDirectionSample sample(double u0, double u1) const override {
            return table_.sample(below_one(u0), below_one(u1));
        }
        float pdf(const float wi[3]) const override { return table_.pdf(wi); }

    private:
        const Table& table_;
    };
    Table table_;
};

/// A LightSampler that makes a `Point` of `Table` and has its bytes().
template <class Table, class Point>
class MovedToPoints : public LightSampler {
public:
    template <class... Arguments>
    explicit MovedToPoints(Arguments&&... arguments) : table_(std::forward<Arguments>(arguments)...) {}

    std::unique_ptr<PointSampler> point_sampler() const override { return std::make_unique<Point>(table_); }
    std::uint64_t bytes() const override { return table_.bytes(); }

private:
    Table table_;
};

} // namespace acdf::measure
