#include "compress/visibility/ray_sites.h"

#include "compress/parallel.h"

#include <algorithm>

namespace acdf::compress {
namespace {

void add_all(const std::vector<float>& from, float times, std::vector<float>& to) {
    const std::size_t count = to.size();
    const float* const a = from.data();
    float* const b = to.data();
    for (std::size_t i = 0; i < count; ++i) b[i] += times * a[i];
}

void subtract(const std::vector<float>& whole, const std::vector<float>& part, std::vector<float>& out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(whole[i] - part[i], 0.0f);
}

} // namespace

void RaySums::clear() {
    for (std::vector<float>* of : {&all, &seen, &light, &cosine}) std::fill(of->begin(), of->end(), 0.0f);
    rays = 0.0f;
}

void RaySums::add(const RaySums& other) {
    add_all(other.all, 1.0f, all);
    add_all(other.seen, 1.0f, seen);
    add_all(other.light, 1.0f, light);
    add_all(other.cosine, 1.0f, cosine);
    rays += other.rays;
}

void RaySums::become_rest(const RaySums& whole, const RaySums& part) {
    subtract(whole.all, part.all, all);
    subtract(whole.seen, part.seen, seen);
    subtract(whole.light, part.light, light);
    subtract(whole.cosine, part.cosine, cosine);
    rays = whole.rays - part.rays;
}

RaySites::RaySites(const VisibilityParts& parts, const VisibilityCounts::Sorted& counts, const BesideCosine* beside)
    : parts_(parts), counts_(counts), part_count_(parts.count()), normals_(VisibilityCounts::normals) {
    std::vector<char> there(normals_.size(), 0);
    for (std::uint32_t i = 0; i < counts.size(); ++i) {
        if (i == 0 || (counts[i].key ^ counts[i - 1].key) >> VisibilityCounts::part_bits) {
            first_.push_back(i);
            rays_.push_back(0.0f);
            there[VisibilityCounts::normal_of(counts[i].key)] = 1;
        }
        rays_.back() += static_cast<float>(counts[i].all);
    }
    first_.push_back(static_cast<std::uint32_t>(counts.size()));
    parallel_for(std::size_t{0}, normals_.size(), [&](std::size_t n) {
        normals_[n].middle = VisibilityCounts::middle_normal(static_cast<std::uint32_t>(n));
        if (there[n]) describe(normals_[n], beside);
    });
}

void RaySites::describe(Normal& out, const BesideCosine* beside) const {
    AcdfLocalPoint point;
    acdf_local_at(&parts_.local(), out.middle.data(), &point);
    out.light.resize(part_count_);
    parts_.weigh(point, out.light.data());
    if (point.length > 0.0)
        for (float& light : out.light) light /= static_cast<float>(point.length);
    out.cosine.assign(part_count_, 0.0f);
    if (!beside) return;
    out.masses = beside->masses(out.middle);
    for (std::size_t g = 0; g < out.masses.size(); ++g) out.cosine[g / BesideCosine::groups] += out.masses[g];
}

float RaySites::coordinate(std::uint32_t site, std::size_t axis) const {
    if (axis >= 3) return normals_[normal(site)].middle[axis - 3];
    const std::uint32_t cell = VisibilityCounts::cell_of(counts_[first_[site]].key, axis);
    return counts_.low(axis) + (static_cast<float>(cell) + 0.5f) * counts_.width();
}

void RaySites::add(std::uint32_t site, RaySums& sums) const {
    for (std::uint32_t i = first_[site]; i < first_[site + 1]; ++i) {
        const std::uint32_t part = VisibilityCounts::part_of(counts_[i].key);
        sums.all[part] += static_cast<float>(counts_[i].all);
        sums.seen[part] += static_cast<float>(counts_[i].seen);
    }
    const Normal& own = normals_[normal(site)];
    add_all(own.light, rays_[site], sums.light);
    if (!own.masses.empty()) add_all(own.cosine, rays_[site], sums.cosine);
    sums.rays += rays_[site];
}

} // namespace acdf::compress
