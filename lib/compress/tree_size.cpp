#include "compress/tree_size.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kNoCurve = 0xFFFFFFFFu;

/// What rounding to each width does to a curve, once it has been asked for.
struct Roundings {
    Rounding of[3];
    bool known[3] = {};
};

} // namespace

struct SizedTree::Curves {
    struct Curve {
        CurveShape shape;  ///< all but the widths
        double reach;      ///< how often sampling comes to it, summed over the bins
        std::uint32_t lit; ///< probabilities above 0
        std::uint32_t first_segment;
        std::shared_ptr<Roundings> roundings;
    };
    std::vector<std::vector<std::uint8_t>> divided; ///< for each bin
    std::vector<Curve> curves;
    std::vector<double> probability;  ///< of all segments
    std::vector<std::uint32_t> child; ///< of all segments: a curve, or kNoCurve

    std::vector<double> probabilities(const Curve& curve) const {
        const auto first = probability.begin() + std::ptrdiff_t(curve.first_segment);
        return {first, first + std::ptrdiff_t(curve.shape.segments)};
    }
};

/// What is known of the curves of a bin, by their parts.
struct TreeSizer::Bin {
    std::vector<std::uint8_t> divided; ///< at the last price
    std::vector<std::shared_ptr<Roundings>> roundings;

    /// A curve is as it was where nothing changed below its part.
    void drop_changed(const PruneNodes& nodes, const Pruned& pruned) {
        if (divided.size() == nodes.size()) {
            std::vector<std::uint8_t> changed(nodes.size(), 0);
            for (std::size_t i = nodes.size(); i-- > 0;) {
                changed[i] = divided[i] != pruned.divided[i];
                for (std::uint32_t k = 0; pruned.divided[i] && k < nodes[i].children; ++k)
                    changed[i] = changed[i] | changed[nodes[i].first_child + k];
                if (changed[i]) roundings[i] = nullptr;
            }
        } else {
            roundings.assign(nodes.size(), nullptr);
        }
        divided = pruned.divided;
    }
};

TreeSizer::TreeSizer(std::size_t bins, double most_ratio) : bins_(bins), most_ratio_(most_ratio) {}
TreeSizer::~TreeSizer() = default;

void TreeSizer::forget() {
    for (Bin& bin : bins_) bin = {};
}

std::shared_ptr<const SizedTree::Curves> TreeSizer::curves_of(const std::vector<PrunedBin>& bins) {
    auto out = std::make_shared<SizedTree::Curves>();
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const std::size_t base = out->curves.size();
        out->divided.push_back(bins[b].pruned->divided);
        if (!bins[b].parts) { // a curve of one segment, never entered
            out->curves.push_back({{},
                                   1.0 / double(bins.size()),
                                   1,
                                   std::uint32_t(out->child.size()),
                                   std::make_shared<Roundings>()});
            out->probability.push_back(1.0);
            out->child.push_back(kNoCurve);
            continue;
        }
        const std::vector<Part>& parts = *bins[b].parts;
        Bin& bin = bins_[b];
        bin.drop_changed(*bins[b].nodes, *bins[b].pruned);
        const std::vector<double> cost = shares_below(*bins[b].nodes, *bins[b].pruned);
        const Outline outlined = outline(*bins[b].nodes, *bins[b].pruned, cost);
        out->curves.resize(base + outlined.curves.size());
        out->curves[base].reach = 1.0 / double(bins.size());
        for (std::size_t c = 0; c < outlined.curves.size(); ++c) {
            const Outline::Curve& from = outlined.curves[c];
            SizedTree::Curves::Curve& curve = out->curves[base + c];
            curve.shape.segments = from.count;
            curve.lit = 0;
            curve.first_segment = static_cast<std::uint32_t>(out->child.size());
            for (auto segment = outlined.begin(from); segment != outlined.end(from); ++segment) {
                const double p = segment_probability(cost, from.part, segment->part);
                out->probability.push_back(p);
                out->child.push_back(
                    segment->child < 0 ? kNoCurve : static_cast<std::uint32_t>(base + std::size_t(segment->child)));
                curve.lit += p > 0.0;
                if (segment->child < 0) continue;
                curve.shape.link_code = 1;
                out->curves[out->child.back()].reach = curve.reach * p;
            }
            const auto low = [&](std::uint32_t part) { return parts[part].box.begin[from.axis]; };
            if (from.count > 1)
                curve.shape.position_code =
                    position_code(low((outlined.end(from) - 1)->part), low(from.part), true);
            auto& roundings = bin.roundings[from.part];
            if (!roundings) roundings = std::make_shared<Roundings>();
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
    for (const SizedTree::Curves::Curve& curve : out.curves->curves)
        out.widths.push_back(static_cast<std::uint8_t>(best_width(
            curve.shape.segments - 1, curve.lit, curve.reach, price, most_ratio_, [&](std::uint32_t code) {
                Roundings& roundings = *curve.roundings;
                if (!roundings.known[code])
                    roundings.of[code] = rounding_to(out.curves->probabilities(curve), code);
                roundings.known[code] = true;
                return roundings.of[code];
            })));
    return out;
}

std::uint64_t TreeSizer::bytes(const SizedTree& tree) const {
    const SizedTree::Curves& all = *tree.curves;
    std::vector<CurveShape> shapes;
    shapes.reserve(all.curves.size());
    for (std::size_t i = 0; i < all.curves.size(); ++i) {
        shapes.push_back(all.curves[i].shape);
        shapes.back().probability_code = tree.widths[i];
    }
    return place(shapes,
                 [&](std::size_t i, const auto& test) {
                     const auto first = all.child.begin() + std::ptrdiff_t(all.curves[i].first_segment);
                     return std::any_of(
                         first, first + std::ptrdiff_t(shapes[i].segments),
                         [&](std::uint32_t child) { return child != kNoCurve && test(std::size_t{child}); });
                 })
        .back();
}

} // namespace acdf::compress
