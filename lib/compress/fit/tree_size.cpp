#include "compress/fit/tree_size.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFFFFFFu;

} // namespace

SizedCurves sized_curves(const PruneNodes& nodes, const std::vector<std::uint32_t>& begins, const Pruned& pruned) {
    const std::vector<double> cost = shares_below(nodes, pruned);
    const Outline outlined = outline(nodes, pruned, cost);
    SizedCurves out;
    out.curves.resize(outlined.curves.size());
    out.probability.reserve(outlined.segments.size());
    for (std::uint32_t c = 0; c < out.curves.size(); ++c) {
        const Outline::Curve& from = outlined.curves[c];
        SizedCurve& curve = out.curves[c];
        curve.part = from.part;
        curve.shape.segments = from.count;
        curve.first_segment = static_cast<std::uint32_t>(out.probability.size());
        for (auto segment = outlined.begin(from); segment != outlined.end(from); ++segment) {
            const double p = segment_probability(cost, from.part, segment->part);
            out.probability.push_back(p);
            curve.lit += p > 0.0;
            if (segment->child < 0) continue;
            const auto child = static_cast<std::uint32_t>(segment->child);
            curve.last_child = curve.shape.link_code == 0 ? child : std::max(curve.last_child, child);
            curve.shape.link_code = 1;
            out.curves[child].parent = c;
            out.curves[child].of_parent = p;
        }
        if (from.count > 1) // the first of the parts that it is divided into begins where it does
            curve.shape.position_code =
                position_code(begins[(outlined.end(from) - 1)->part], begins[nodes[from.part].first_child], true);
    }
    return out;
}

struct SizedTree::Curves {
    std::vector<std::vector<std::uint8_t>> divided; ///< for each bin
    SizedCurves all;                                ///< children numbered through all bins, parents are not
    std::vector<double> reach;                      ///< how often sampling comes to each, summed over the bins
    std::vector<std::uint32_t> roundings;           ///< of each, the sizer's
};

/// What is known of the curves of a bin, by their parts.
struct TreeSizer::Bin {
    std::vector<std::uint8_t> divided;    ///< at the last price
    std::vector<std::uint32_t> roundings; ///< of the sizer's, or kUnknown

    /// A curve is as it was where nothing changed below its part.
    void drop_changed(const PruneNodes& nodes, const Pruned& pruned) {
        if (divided.size() == nodes.size()) {
            std::vector<std::uint8_t> changed(nodes.size(), 0);
            for (std::size_t i = nodes.size(); i-- > 0;) {
                changed[i] = divided[i] != pruned.divided[i];
                for (std::uint32_t k = 0; pruned.divided[i] && k < nodes[i].children; ++k)
                    changed[i] = changed[i] | changed[nodes[i].first_child + k];
                if (changed[i]) roundings[i] = kUnknown;
            }
        } else {
            roundings.assign(nodes.size(), kUnknown);
        }
        divided = pruned.divided;
    }
};

TreeSizer::TreeSizer(std::size_t bins, double most_ratio) : bins_(bins), most_ratio_(most_ratio) {}
TreeSizer::~TreeSizer() = default;

void TreeSizer::forget() {
    for (Bin& bin : bins_) bin = {};
    roundings_.clear();
}

std::uint32_t TreeSizer::add_roundings() {
    roundings_.emplace_back();
    return static_cast<std::uint32_t>(roundings_.size() - 1);
}

std::shared_ptr<const SizedTree::Curves> TreeSizer::curves_of(const std::vector<PrunedBin>& bins) {
    auto out = std::make_shared<SizedTree::Curves>();
    const double root = 1.0 / double(bins.size());
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const auto base = static_cast<std::uint32_t>(out->all.curves.size()),
                   first = static_cast<std::uint32_t>(out->all.probability.size());
        const PruneNodes& nodes = *bins[b].nodes;
        out->divided.push_back(bins[b].pruned->divided);
        if (nodes.empty()) { // a curve of one segment, never entered
            SizedCurve& curve = out->all.curves.emplace_back();
            curve.lit = 1;
            curve.first_segment = first;
            out->all.probability.push_back(1.0);
            out->reach.push_back(root);
            out->roundings.push_back(add_roundings());
            continue;
        }
        Bin& bin = bins_[b];
        bin.drop_changed(nodes, *bins[b].pruned);
        const SizedCurves own = sized_curves(nodes, *bins[b].begins, *bins[b].pruned);
        out->all.probability.insert(out->all.probability.end(), own.probability.begin(), own.probability.end());
        for (SizedCurve curve : own.curves) {
            const bool is_root = curve.parent == SizedCurve::none;
            out->reach.push_back(is_root ? root : out->reach[base + curve.parent] * curve.of_parent);
            curve.first_segment += first;
            if (curve.shape.link_code > 0) curve.last_child += base;
            std::uint32_t& roundings = bin.roundings[curve.part];
            if (roundings == kUnknown) roundings = add_roundings();
            out->roundings.push_back(roundings);
            out->all.curves.push_back(curve);
        }
    }
    return out;
}

SizedTree TreeSizer::tree(const std::vector<PrunedBin>& bins, double price,
                          const std::vector<const SizedTree*>& known) {
    SizedTree out;
    for (const SizedTree* other : known) {
        if (!other->curves) continue;
        const auto& divided = other->curves->divided;
        if (std::equal(divided.begin(), divided.end(), bins.begin(), bins.end(),
                       [](const auto& a, const PrunedBin& b) { return a == b.pruned->divided; }))
            out.curves = other->curves;
    }
    if (!out.curves) out.curves = curves_of(bins);
    const SizedTree::Curves& curves = *out.curves;
    out.widths.reserve(curves.all.curves.size());
    for (std::size_t i = 0; i < curves.all.curves.size(); ++i) {
        const SizedCurve& curve = curves.all.curves[i];
        const auto rounding = [&](std::uint32_t code) {
            return roundings_[curves.roundings[i]].to(code, curves.all, curve);
        };
        out.widths.push_back(static_cast<std::uint8_t>(
            best_width(curve.shape.segments - 1, curve.lit, curves.reach[i], price, most_ratio_, rounding)));
    }
    return out;
}

std::uint64_t TreeSizer::bytes(const SizedTree& tree) const {
    const std::vector<SizedCurve>& curves = tree.curves->all.curves;
    std::vector<CurveShape> shapes;
    shapes.reserve(curves.size());
    for (std::size_t i = 0; i < curves.size(); ++i) {
        shapes.push_back(curves[i].shape);
        shapes.back().probability_code = tree.widths[i];
    }
    const auto farthest = [&](std::size_t i, const auto& test) { return test(std::size_t{curves[i].last_child}); };
    return place(shapes, farthest).back(); // asks only of curves that have links
}

} // namespace acdf::compress
