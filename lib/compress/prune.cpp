#include "compress/prune.h"

#include <acdf/sample.h>

#include <algorithm>
#include <limits>

namespace acdf::compress {

Pruned prune(const std::vector<Part>& parts, double price, double heaviest) {
    Pruned out;
    out.divided.assign(parts.size(), false);
    out.cells.assign(parts.size(), 1);
    std::vector<double> value(parts.size()); // cost and price of the best tree below a part
    for (std::size_t i = parts.size(); i-- > 0;) {
        const Part& part = parts[i];
        value[i] = part.moments.cost();
        if (part.split == Part::whole) continue;
        double divided = price * kKnotBytes * (part.children - 1);
        std::uint32_t count = 0;
        for (std::uint32_t k = part.first_child; k < part.first_child + part.children; ++k) {
            divided += value[k];
            if (out.divided[k] && parts[k].split != part.split) divided += price * kCurveBytes;
            count += out.cells[k];
        }
        if (divided >= value[i] && part.moments.weight() <= heaviest) continue;
        value[i] = divided;
        out.divided[i] = true;
        out.cells[i] = count;
    }
    return out;
}

std::vector<bool> may_pay(const std::vector<Part>& parts, double price) {
    constexpr double rounding = 1e-9; // of the cost: far more than sums of costs are off by
    std::vector<bool> out(parts.size(), false);
    std::vector<double> value(parts.size()); // at most what prune() makes of it at that price
    for (std::size_t i = parts.size(); i-- > 0;) {
        const Part& part = parts[i];
        value[i] = part.moments.cost();
        if (part.split == Part::whole) continue;
        double divided = price * kKnotBytes * (part.children - 1);
        for (std::uint32_t k = part.first_child; k < part.first_child + part.children; ++k) divided += value[k];
        out[i] = divided < value[i] * (1.0 + rounding);
        value[i] = std::min(value[i], divided);
    }
    return out;
}

namespace {

class Flattener {
public:
    Flattener(const Partition& partition, const Pruned& pruned, Flattened& out)
        : grid_(partition.grid()), parts_(partition.parts()), pruned_(pruned), cost_(parts_.size(), 0.0),
          out_(out) {
        for (std::size_t i = parts_.size(); i-- > 0;) {
            cost_[i] = pruned.divided[i] ? 0.0 : parts_[i].moments.cost();
            for (std::uint32_t k = 0; pruned.divided[i] && k < parts_[i].children; ++k)
                cost_[i] += cost_[parts_[i].first_child + k];
        }
    }

    void run() {
        out_.cascade.roots.push_back(static_cast<std::uint32_t>(out_.cascade.curves.size()));
        out_.cost.push_back(cost_[0]);
        add_curve(0);
    }

private:
    /// The parts that become the segments of a curve that starts at part i.
    void collect(std::uint32_t i, std::int8_t split, std::vector<std::uint32_t>& segments) const {
        if (!pruned_.divided[i] || parts_[i].split != split) {
            segments.push_back(i);
            return;
        }
        for (std::uint32_t k = 0; k < parts_[i].children; ++k) collect(parts_[i].first_child + k, split, segments);
    }

    std::int32_t add_curve(std::uint32_t i) {
        const std::int8_t split = pruned_.divided[i] ? parts_[i].split : std::int8_t{0};
        std::vector<std::uint32_t> segments;
        collect(i, split, segments);
        const std::size_t index = out_.cascade.curves.size();
        out_.cascade.curves.emplace_back();
        out_.weights.emplace_back();
        Curve curve;
        std::vector<float> weights;
        const auto axis = static_cast<std::size_t>(split);
        curve.axis = grid_.axes[axis];
        for (std::size_t s = 0; s < segments.size(); ++s) {
            const Part& part = parts_[segments[s]];
            if (s > 0) curve.knots.push_back(part.box.begin[axis]);
            curve.probability.push_back(cost_[i] > 0.0 ? cost_[segments[s]] / cost_[i] : 1.0);
            weights.push_back(static_cast<float>(part.moments.weight()));
        }
        curve.children = add_children(segments);
        out_.cascade.curves[index] = std::move(curve);
        out_.weights[index] = std::move(weights);
        return static_cast<std::int32_t>(index);
    }

    /// Small subtrees first: most links are then short enough for one byte.
    std::vector<std::int32_t> add_children(const std::vector<std::uint32_t>& segments) {
        std::vector<std::size_t> order;
        for (std::size_t s = 0; s < segments.size(); ++s)
            if (pruned_.divided[segments[s]] && cost_[segments[s]] > 0.0) order.push_back(s);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return pruned_.cells[segments[a]] < pruned_.cells[segments[b]];
        });
        std::vector<std::int32_t> children(segments.size(), -1);
        for (std::size_t s : order) children[s] = add_curve(segments[s]);
        return children;
    }

    const Grid& grid_;
    const std::vector<Part>& parts_;
    const Pruned& pruned_;
    std::vector<double> cost_; ///< of the cells below each part
    Flattened& out_;
};

} // namespace

void flatten(const Partition& partition, const Pruned& pruned, Flattened& out) {
    Flattener(partition, pruned, out).run();
}

void flatten_nothing(std::uint32_t axis, Flattened& out) {
    out.cascade.roots.push_back(static_cast<std::uint32_t>(out.cascade.curves.size()));
    Curve curve;
    curve.axis = axis;
    curve.probability = {1.0};
    out.cascade.curves.push_back(std::move(curve));
    out.weights.push_back({0.0f});
    out.cost.push_back(0.0);
}

StoredQuality stored_quality(const Flattened& flat, std::size_t bin, const EncodedTree& tree) {
    struct Visit {
        std::uint32_t curve, offset;
        double probability, stored;
    };
    StoredQuality quality;
    quality.excess = 0.0;
    std::vector<Visit> stack{{flat.cascade.roots[bin], tree.roots[bin], 1.0, 1.0}};
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        const Curve& curve = flat.cascade.curves[visit.curve];
        const AcdfCurve stored = acdf_curve_at(tree.bytes.data(), visit.offset);
        const double maximum = acdf_curve_maximum(&stored);
        for (std::uint32_t s = 0; s < stored.segments; ++s) {
            const double p = visit.probability * curve.probability[s];
            const double width = acdf_curve_cumulative(&stored, s + 1) - acdf_curve_cumulative(&stored, s);
            const double q = visit.stored * width / maximum;
            const std::uint32_t link = acdf_curve_link(&stored, s);
            if (link != 0) {
                stack.push_back({static_cast<std::uint32_t>(curve.children[s]), visit.offset + link, p, q});
            } else if (p > 0.0) {
                quality.excess += p * (p / q);
                // f/p in a cell of cost C is weight * (sum of C), with the best p; q takes its place.
                quality.max_weight =
                    std::max(quality.max_weight, flat.weights[visit.curve][s] * flat.cost[bin] * (p / q));
            }
        }
    }
    return quality;
}

} // namespace acdf::compress
