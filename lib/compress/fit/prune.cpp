#include "compress/fit/prune.h"

#include "compress/fit/outline.h"

#include <acdf/sample.h>

#include <algorithm>
#include <limits>

namespace acdf::compress {

PruneNodes prune_nodes(const std::vector<Part>& parts, double heaviest, const Filling* filling) {
    PruneNodes out;
    out.reserve(parts.size());
    for (const Part& part : parts)
        out.push_back({part.moments.cost(), part.moments.share(filling), part.first_child,
                       static_cast<std::uint16_t>(part.children), part.split, part.moments.above(heaviest)});
    return out;
}

std::vector<std::uint32_t> begins_of(const std::vector<Part>& parts) {
    std::vector<std::uint32_t> out(parts.size(), 0);
    for (const Part& part : parts)
        for (std::uint32_t k = part.first_child; k < part.first_child + part.children; ++k)
            out[k] = parts[k].box.begin[static_cast<std::size_t>(part.split)];
    return out;
}

Pruned prune(const PruneNodes& nodes, double price) {
    Pruned out;
    out.divided.assign(nodes.size(), 0);
    out.cells.assign(nodes.size(), 1);
    std::vector<double> value(nodes.size()); // cost and price of the best tree below a part
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const PruneNode& node = nodes[i];
        value[i] = node.cost;
        if (node.split == Part::whole) continue;
        double divided = price * kKnotBytes * (node.children - 1);
        std::uint32_t count = 0;
        for (std::uint32_t k = node.first_child; k < node.first_child + node.children; ++k) {
            divided += value[k];
            if (out.divided[k] && nodes[k].split != node.split) divided += price * kCurveBytes;
            count += out.cells[k];
        }
        if (divided >= value[i] && !node.heavy) continue;
        value[i] = divided;
        out.divided[i] = 1;
        out.cells[i] = count;
    }
    return out;
}

Pruned prune(const std::vector<Part>& parts, double price, double heaviest) {
    return prune(prune_nodes(parts, heaviest), price);
}

std::vector<bool> may_pay(const std::vector<Part>& parts, double price, double heaviest) {
    constexpr double rounding = 1e-9; // of the cost: far more than sums of costs are off by
    std::vector<bool> out(parts.size(), false);
    std::vector<double> value(parts.size()); // at most what prune() makes of it at that price
    for (std::size_t i = parts.size(); i-- > 0;) {
        const Part& part = parts[i];
        value[i] = part.moments.cost();
        if (part.split == Part::whole) continue;
        double divided = price * kKnotBytes * (part.children - 1);
        for (std::uint32_t k = part.first_child; k < part.first_child + part.children; ++k) divided += value[k];
        const bool heavy = part.moments.above(heaviest);
        out[i] = heavy || divided < value[i] * (1.0 + rounding);
        value[i] = heavy ? divided : std::min(value[i], divided);
    }
    return out;
}

void flatten(const Partition& partition, const PruneNodes& nodes, const Pruned& pruned, Flattened& out) {
    const std::vector<Part>& parts = partition.parts();
    const std::vector<double> cost = shares_below(nodes, pruned);
    const Outline curves = outline(nodes, pruned, cost);
    const auto base = static_cast<std::int32_t>(out.cascade.curves.size());
    out.cascade.roots.push_back(static_cast<std::uint32_t>(base));
    out.cost.push_back(cost[0]);
    for (const Outline::Curve& from : curves.curves) {
        Curve& curve = out.cascade.curves.emplace_back();
        std::vector<float>& weights = out.weights.emplace_back();
        curve.axis = partition.grid().axes[from.axis];
        curve.knots.reserve(from.count);
        curve.probability.reserve(from.count);
        curve.children.reserve(from.count);
        weights.reserve(from.count);
        for (std::uint32_t s = 0; s < from.count; ++s) {
            const Outline::Segment& segment = curves.begin(from)[s];
            const Part& part = parts[segment.part];
            if (s > 0) curve.knots.push_back(part.box.begin[from.axis]);
            curve.probability.push_back(segment_probability(cost, from.part, segment.part));
            curve.children.push_back(segment.child < 0 ? -1 : base + segment.child);
            weights.push_back(static_cast<float>(part.moments.weight()));
        }
    }
}

void flatten(const Partition& partition, const Pruned& pruned, Flattened& out) {
    const double any = std::numeric_limits<double>::infinity();
    flatten(partition, prune_nodes(partition.parts(), any, partition.grid().filling), pruned, out);
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
