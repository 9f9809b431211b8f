#include "compress/tree_size.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kNoSlot = 0xFFFFFFFFu;

} // namespace

void TreeSize::begin() {
    added_.clear();
    tree_ = {};
    curves_ = 0;
}

void TreeSize::forget() {
    for (Bin& bin : bins_) bin = {};
}

/// A curve is as it was where nothing changed below its part.
void TreeSize::drop_changed(const std::vector<Part>& parts, const Pruned& pruned, Bin& bin) const {
    if (bin.divided.size() != parts.size()) {
        bin = {};
        bin.slot.assign(parts.size(), kNoSlot);
    } else {
        std::vector<std::uint8_t> changed(parts.size(), 0);
        for (std::size_t i = parts.size(); i-- > 0;) {
            changed[i] = bin.divided[i] != pruned.divided[i];
            for (std::uint32_t k = 0; pruned.divided[i] && k < parts[i].children; ++k)
                changed[i] = changed[i] | changed[parts[i].first_child + k];
            if (changed[i] && bin.slot[i] != kNoSlot) bin.roundings[bin.slot[i]] = {};
        }
    }
    bin.divided = pruned.divided;
}

void TreeSize::add(const std::vector<Part>* parts, const Pruned& pruned) {
    Added added{parts, {}, {}, curves_};
    tree_.divided.push_back(pruned.divided);
    if (parts) {
        drop_changed(*parts, pruned, bins_[added_.size()]);
        added.cost = costs_below(*parts, pruned);
        added.outline = outline(*parts, pruned, added.cost);
    }
    curves_ += parts ? added.outline.curves.size() : 1;
    added_.push_back(std::move(added));
}

CurveShape TreeSize::shape_of(const Added& added, const Outline::Curve& curve, double reach, double price,
                              Bin& bin) {
    CurveShape shape;
    shape.segments = curve.count;
    probability_.clear();
    std::uint64_t lit = 0;
    for (auto segment = added.outline.begin(curve); segment != added.outline.end(curve); ++segment) {
        probability_.push_back(segment_probability(added.cost, curve.part, segment->part));
        lit += probability_.back() > 0.0;
        if (segment->child >= 0) shape.link_code = 1;
    }
    const auto low = [&](std::uint32_t part) { return (*added.parts)[part].box.begin[curve.axis]; };
    if (curve.count > 1)
        shape.position_code = position_code(low((added.outline.end(curve) - 1)->part), low(curve.part), true);
    std::uint32_t& slot = bin.slot[curve.part];
    if (slot == kNoSlot) {
        slot = static_cast<std::uint32_t>(bin.roundings.size());
        bin.roundings.emplace_back();
    }
    Roundings& known = bin.roundings[slot];
    shape.probability_code = best_width(curve.count - 1, lit, reach, price, most_ratio_, [&](std::uint32_t code) {
        if (!known.known[code]) known.of[code] = rounding_to(probability_, code);
        known.known[code] = true;
        return known.of[code];
    });
    return shape;
}

std::uint64_t TreeSize::placed(std::vector<CurveShape>& shapes) const {
    std::size_t b = 0;
    const auto any_child = [&](std::size_t i, const auto& test) {
        while (i < added_[b].first_curve) --b; // the first curve again
        while (b + 1 < added_.size() && added_[b + 1].first_curve <= i) ++b;
        const Added& added = added_[b];
        const Outline::Curve& curve = added.outline.curves[i - added.first_curve]; // one that has links
        return std::any_of(added.outline.begin(curve), added.outline.end(curve), [&](const auto& segment) {
            return segment.child >= 0 && test(added.first_curve + std::size_t(segment.child));
        });
    };
    return place(shapes, any_child).back();
}

std::uint64_t TreeSize::finish(double price) {
    std::vector<CurveShape> shapes(curves_);
    std::vector<double> reach(curves_, 0.0); // how often sampling comes to a curve, summed over the bins
    for (std::size_t b = 0; b < added_.size(); ++b) {
        const Added& added = added_[b];
        reach[added.first_curve] = 1.0 / double(added_.size());
        for (std::size_t c = 0; c < added.outline.curves.size(); ++c) {
            const Outline::Curve& curve = added.outline.curves[c];
            const std::size_t index = added.first_curve + c;
            shapes[index] = shape_of(added, curve, reach[index], price, bins_[b]);
            for (std::uint32_t s = 0; s < curve.count; ++s)
                if (const std::int32_t child = added.outline.begin(curve)[s].child; child >= 0)
                    reach[added.first_curve + std::size_t(child)] = reach[index] * probability_[s];
        }
    }
    for (const CurveShape& shape : shapes)
        tree_.widths.push_back(static_cast<std::uint8_t>(shape.probability_code));
    return placed(shapes);
}

} // namespace acdf::compress
