#include "compress/fit/tree_size.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kNoCurve = 0xFFFFFFFFu, kUnknown = 0xFFFFFFFFu;

} // namespace

/// What rounding to each width does to a curve, once it has been asked for.
struct TreeSizer::Roundings {
    Rounding of[3];
    bool known[3] = {};
};

struct SizedTree::Curves {
    struct Curve {
        CurveShape shape;  ///< all but the widths
        double reach;      ///< how often sampling comes to it, summed over the bins
        std::uint32_t lit; ///< probabilities above 0
        std::uint32_t first_segment;
        std::uint32_t last_child; ///< the curve below it that lies farthest away, or kNoCurve
        std::uint32_t roundings;  ///< of the sizer's
    };
    std::vector<std::vector<std::uint8_t>> divided; ///< for each bin
    std::vector<Curve> curves;
    std::vector<double> probability; ///< of all segments

    std::vector<double> probabilities(const Curve& curve) const {
        const auto first = probability.begin() + std::ptrdiff_t(curve.first_segment);
        return {first, first + std::ptrdiff_t(curve.shape.segments)};
    }
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
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const std::size_t base = out->curves.size(), first = out->probability.size();
        const PruneNodes& nodes = *bins[b].nodes;
        out->divided.push_back(bins[b].pruned->divided);
        if (nodes.empty()) { // a curve of one segment, never entered
            out->curves.push_back(
                {{}, 1.0 / double(bins.size()), 1, static_cast<std::uint32_t>(first), kNoCurve, add_roundings()});
            out->probability.push_back(1.0);
            continue;
        }
        Bin& bin = bins_[b];
        bin.drop_changed(nodes, *bins[b].pruned);
        const std::vector<double> cost = shares_below(nodes, *bins[b].pruned);
        const Outline outlined = outline(nodes, *bins[b].pruned, cost);
        out->curves.resize(base + outlined.curves.size());
        out->probability.resize(first + outlined.segments.size());
        out->curves[base].reach = 1.0 / double(bins.size());
        double* probability = out->probability.data() + first;
        for (std::size_t c = 0; c < outlined.curves.size(); ++c) {
            const Outline::Curve& from = outlined.curves[c];
            SizedTree::Curves::Curve& curve = out->curves[base + c];
            curve.shape.segments = from.count;
            curve.lit = 0;
            curve.first_segment = static_cast<std::uint32_t>(probability - out->probability.data());
            curve.last_child = kNoCurve;
            for (auto segment = outlined.begin(from); segment != outlined.end(from); ++segment) {
                const double p = segment_probability(cost, from.part, segment->part);
                *probability++ = p;
                curve.lit += p > 0.0;
                if (segment->child < 0) continue;
                const auto child = static_cast<std::uint32_t>(base + std::size_t(segment->child));
                curve.last_child = curve.last_child == kNoCurve ? child : std::max(curve.last_child, child);
                curve.shape.link_code = 1;
                out->curves[child].reach = curve.reach * p;
            }
            if (from.count > 1) // the first of the parts that it is divided into begins where it does
                curve.shape.position_code = position_code((*bins[b].begins)[(outlined.end(from) - 1)->part],
                                                          (*bins[b].begins)[nodes[from.part].first_child], true);
            std::uint32_t& roundings = bin.roundings[from.part];
            if (roundings == kUnknown) roundings = add_roundings();
            curve.roundings = roundings;
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
    out.widths.reserve(out.curves->curves.size());
    for (const SizedTree::Curves::Curve& curve : out.curves->curves) {
        Roundings& roundings = roundings_[curve.roundings];
        const auto rounding = [&](std::uint32_t code) {
            if (!roundings.known[code]) roundings.of[code] = rounding_to(out.curves->probabilities(curve), code);
            roundings.known[code] = true;
            return roundings.of[code];
        };
        out.widths.push_back(static_cast<std::uint8_t>(
            best_width(curve.shape.segments - 1, curve.lit, curve.reach, price, most_ratio_, rounding)));
    }
    return out;
}

std::uint64_t TreeSizer::bytes(const SizedTree& tree) const {
    const std::vector<SizedTree::Curves::Curve>& curves = tree.curves->curves;
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
