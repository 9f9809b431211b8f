#include "tools/render/sampler_build.h"

#include "build/brdf.h"
#include "measure/samplers/estimators.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/product_baselines.h"
#include "measure/samplers/product_samplers.h"
#include "measure/samplers/product_warp.h"
#include "measure/samplers/stratified_map.h"
#include "measure/scenes/portals.h"
#include "measure/scenes/surface_points.h"
#include "tools/cli/built.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/file_input.h"
#include "tools/cli/mesh_visibility.h"
#include "tools/commands.h"
#include "tools/render/learned.h"
#include "tools/render/portals.h"

#include <acdf/curves/curves.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>

namespace acdf::tools {

using measure::LightSamplerPtr;

/// A sampler and what it refers to.
struct SamplerTable {
    std::shared_ptr<const void> keep;
    LightSamplerPtr sampler;
    const File* file = nullptr; ///< that it samples from; null where there is none
};

namespace {

using Table = SamplerTable;

/// Along each axis of a portal's map: as fine, in its middle, as a probe of 1024 x 512.
constexpr std::uint32_t kPortalCells = 512;

Table file_table(std::vector<std::uint8_t> bytes) {
    auto loaded = std::make_shared<LoadedFile>();
    loaded->bytes = std::move(bytes);
    const Status status =
        File::from_memory(loaded->bytes.data(), loaded->bytes.size(), loaded->file, with_curves());
    if (!status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
    LightSamplerPtr sampler = measure::file_sampler(loaded->file);
    const File* file = &loaded->file;
    return {loaded, std::move(sampler), file};
}

Table env_table(const builder::Target& target, const SamplerSpec& spec,
                const std::vector<builder::SceneNormal>& normals) {
    builder::EnvironmentOptions options;
    options.goal = builder::Goal::of_budget(spec.bytes);
    options.mis = spec.mis;
    if (spec.of_scene) options.normals = normals;
    builder::Environment made;
    throw_unless_built(builder::environment(target, options, made));
    return file_table(std::move(made.bytes));
}

Table local_table(const builder::Target& target, const SamplerSpec& spec,
                  const std::vector<builder::SceneNormal>& normals) {
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(spec.bytes);
    options.mis = spec.mis;
    if (spec.of_scene) options.normals = normals;
    builder::Local made;
    throw_unless_built(builder::local(target, options, made));
    return file_table(std::move(made.bytes));
}

/// `portals`: those of the scene, too.
Table visibility_table(const builder::Target& target, const measure::Geometry& geometry, const SamplerSpec& spec,
                       bool portals) {
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(spec.bytes);
    options.visibility.beside_cosine = spec.mis.kind == ACDF_PARTNER_COSINE;
    const compress::VisibilityScene scene = measure::visibility_scene(geometry);
    if (geometry.turned) turn_from_y_up(options.visibility);
    for (std::size_t i = 0; portals && i < geometry.portals.size(); ++i)
        options.visibility.portals.push_back(portal_of(options.visibility, geometry.portals[i]));
    options.visibility.point = [&](std::uint64_t index, builder::VisibilityPoint& out) {
        compress::VisibilityPoint point;
        if (!scene.points(index, point)) return false;
        std::copy_n(point.position.begin(), 3, out.position);
        std::copy_n(point.normal.begin(), 3, out.normal);
        return true;
    };
    options.visibility.occluded = [&](const builder::VisibilityPoint& from, const float direction[3]) {
        compress::VisibilityPoint point;
        std::copy_n(from.position, 3, point.position.begin());
        std::copy_n(from.normal, 3, point.normal.begin());
        return scene.occluded(point, {direction[0], direction[1], direction[2]});
    };
    builder::Local made;
    throw_unless_built(builder::local(target, options, made));
    return file_table(std::move(made.bytes));
}

Table brdf_table(const input::Brdf& brdf, std::uint64_t bytes) {
    builder::BrdfOptions options;
    options.source.name = brdf.name;
    options.source.sha256 = brdf.sha256;
    options.goal = builder::Goal::of_budget(bytes);
    builder::BrdfFile made;
    throw_unless_built(builder::brdf(builder::described(brdf), options, made));
    return file_table(std::move(made.bytes));
}

Table full_brdf_table(const input::Brdf& brdf, bool centre) {
    const auto kind = centre ? measure::BrdfTableKind::centre : measure::BrdfTableKind::mean;
    const auto table = std::make_shared<const measure::TabulatedBrdf>(
        build::reflected_light(brdf, ACDF_CHANNELS_WEIGHTED, {}), brdf.isotropic, kind);
    return {table, measure::tabulated_brdf_sampler(*table)};
}

/// `at`: where among several maps.
Table given_file(const std::string& path, const std::vector<std::string>& at) {
    auto loaded = std::make_shared<LoadedFile>(load_file(path));
    const File* file = &loaded->file;
    LightSamplerPtr sampler = file->kind() == ACDF_KIND_INDEXED
                                  ? measure::sky_sampler(*file, chosen_environment(path, *loaded, at))
                                  : measure::file_sampler(*file);
    return {loaded, std::move(sampler), file};
}

[[noreturn]] void fail_without_scene(const SamplerSpec& spec) {
    throw SpecError("sampler '" + spec.text + "': it needs a scene");
}

/// As samplers of texels see them, which stay as long as these.
compress::Target texels_of(const compress::Target& target) {
    compress::Target other;
    return compress::of_texels(target, other);
}

bool knows_brdf(const SamplerSpec& spec) {
    if (spec.kind != SamplerKind::mis && !spec.parts.empty()) return knows_brdf(spec.parts.back());
    return spec.kind == SamplerKind::brdf || spec.kind == SamplerKind::brdf_table;
}

bool is_ours(const SamplerSpec& spec) {
    if (!spec.parts.empty()) return std::any_of(spec.parts.begin(), spec.parts.end(), is_ours);
    return spec.kind == SamplerKind::env || spec.kind == SamplerKind::local || spec.kind == SamplerKind::brdf ||
           spec.kind == SamplerKind::visibility || spec.kind == SamplerKind::visibility_portals ||
           spec.kind == SamplerKind::learned || spec.kind == SamplerKind::file || spec.kind == SamplerKind::product;
}

} // namespace

struct SamplerBuilder::Store {
    builder::Target fitted;
    compress::Target target; ///< its texels
    std::vector<const input::Brdf*> brdfs;
    std::string data;
    std::vector<builder::SceneNormal> normals;
    const measure::Geometry* geometry;
    const std::vector<measure::ScenePoint>* points;
    std::vector<std::string> at;
    std::map<std::string, SamplerTable> tables; ///< by text, and the material where that matters
    std::map<std::string, std::unique_ptr<const measure::StratifiedMap>> maps;
    std::vector<std::unique_ptr<measure::Estimator>> estimators;

    Table make(const SamplerSpec& spec, std::size_t material) const {
        switch (spec.kind) {
        case SamplerKind::full_cdf:
        case SamplerKind::ris:
            return {nullptr, measure::full_cdf_sampler(target)};
        case SamplerKind::cosine:
            return {nullptr, measure::cosine_sampler()};
        case SamplerKind::tiles:
            return {nullptr, measure::tiling_sampler(target, spec.columns, spec.rows)};
        case SamplerKind::ggx:
            return {nullptr, measure::ggx_sampler(spec.alpha)};
        case SamplerKind::env:
            return env_table(fitted, spec, normals);
        case SamplerKind::local:
            return local_table(fitted, spec, normals);
        case SamplerKind::visibility_cache:
            if (!points) fail_without_scene(spec);
            return {nullptr, measure::visibility_sampler(target, spec.columns, spec.rows, *points)};
        case SamplerKind::portals:
            if (!geometry) fail_without_scene(spec);
            return {nullptr, spec.uniform ? measure::uniform_portal_sampler(geometry->portals, geometry->turned)
                                          : measure::windowed_portal_sampler(target, geometry->portals,
                                                                             geometry->turned, kPortalCells)};
        case SamplerKind::visibility:
            if (!geometry) fail_without_scene(spec);
            return visibility_table(fitted, *geometry, spec, false);
        case SamplerKind::visibility_portals:
            if (!geometry) fail_without_scene(spec);
            if (geometry->portals.empty()) throw SpecError("sampler '" + spec.text + "': the scene has no portals");
            return visibility_table(fitted, *geometry, spec, true);
        case SamplerKind::learned: {
            if (!points) fail_without_scene(spec);
            LearnedSampler made =
                learned_sampler(fitted, *points, spec.bytes, spec.mis.kind == ACDF_PARTNER_COSINE);
            return {made.file, std::move(made.sampler), made.file.get()};
        }
        case SamplerKind::brdf:
            return brdf_table(*brdfs[material], spec.bytes);
        case SamplerKind::brdf_table:
            return full_brdf_table(*brdfs[material], spec.centre);
        case SamplerKind::file:
            return given_file((std::filesystem::path(data) / spec.path).string(), at);
        case SamplerKind::alias:
            return {nullptr, measure::alias_sampler(target)};
        case SamplerKind::hierarchical:
            return {nullptr, measure::hierarchical_sampler(target)};
        case SamplerKind::downsampled:
            return {nullptr, measure::downsampled_cdf_sampler(target, spec.columns, spec.rows)};
        case SamplerKind::compensated:
            return {nullptr, measure::compensated_sampler(target)};
        case SamplerKind::ideal:
            return {nullptr, measure::ideal_sampler(target, spec.mis.kind == ACDF_PARTNER_NONE
                                                                ? 0.0
                                                                : spec.mis.light / spec.mis.other)};
        case SamplerKind::strata:
        case SamplerKind::mis:
        case SamplerKind::product:
        case SamplerKind::warp:
            break;
        }
        throw std::logic_error("not a sampler of single directions");
    }
    const Table& table(const SamplerSpec& spec, std::size_t material) {
        if (!spec.parts.empty() && spec.kind == SamplerKind::tiles) return tiles(spec, material);
        const std::string text = spec.kind == SamplerKind::ris ? "full-cdf" : spec.text;
        const std::string key = knows_brdf(spec) ? text + "@" + std::to_string(material) : text;
        auto found = tables.find(key);
        if (found == tables.end()) found = tables.emplace(key, make(spec, material)).first;
        return found->second;
    }
    const measure::LightSampler& sampler(const SamplerSpec& spec, std::size_t material) {
        return *table(spec, material).sampler;
    }
    /// The table of that name, made where there is none.
    template <class Make> // LightSamplerPtr make()
    const Table& kept(const std::string& text, std::size_t material, const Make& make_sampler) {
        const std::string key = text + "@" + std::to_string(material);
        auto found = tables.find(key);
        if (found == tables.end()) found = tables.emplace(key, Table{nullptr, make_sampler()}).first;
        return found->second;
    }
    const Table& tiles(const SamplerSpec& spec, std::size_t material) {
        const File* brdf = table(spec.parts[0], material).file;
        return kept(spec.text, material, [&] {
            return brdf ? measure::product_tiles_sampler(target, spec.columns, spec.rows, *brdf)
                        : measure::product_tiles_sampler(target, spec.columns, spec.rows, spec.parts[0].alpha);
        });
    }
    const measure::LightSampler& product(const SamplerSpec& spec, std::size_t material, std::uint32_t samples) {
        const int parts = spec.divisions ? static_cast<int>(spec.divisions) : measure::product_parts(samples);
        const File* light = table(spec.parts[0], material).file;
        const File* brdf = table(spec.parts[1], material).file;
        if (light->partner())
            throw SpecError("sampler '" + spec.text +
                            "': the pdf of its light is 0 where the MIS partner suffices");
        const Table& made = kept(spec.text + "/" + std::to_string(parts), material, [&] {
            return brdf ? measure::product_sampler(*light, *brdf, parts)
                        : measure::product_sampler(*light, spec.parts[1].alpha, parts);
        });
        return *made.sampler;
    }
    const measure::LightSampler& warp(const SamplerSpec& spec, std::size_t material) {
        const File* light = table(spec.parts[0], material).file;
        const File* brdf = table(spec.parts[1], material).file;
        if (light->partner())
            throw SpecError("sampler '" + spec.text +
                            "': the pdf of its light is 0 where the MIS partner suffices");
        return *kept(spec.text, material, [&] {
                    return brdf ? measure::product_warp_sampler(*light, *brdf)
                                : measure::product_warp_sampler(*light, spec.parts[1].alpha);
                }).sampler;
    }
    /// One that single directions are sampled from, made for `samples` at a point.
    const measure::LightSampler& single(const SamplerSpec& spec, std::size_t material, std::uint32_t samples) {
        if (spec.kind == SamplerKind::product) return product(spec, material, samples);
        return spec.kind == SamplerKind::warp ? warp(spec, material) : sampler(spec, material);
    }
    const measure::LightSampler& candidates(const SamplerSpec& spec, std::size_t material) {
        if (spec.parts.empty()) return sampler(spec, material);
        const measure::LightSampler &a = sampler(spec.parts[0], material), &b = sampler(spec.parts[1], material);
        return *kept(spec.text, material, [&] { return measure::half_and_half(a, b); }).sampler;
    }
    const measure::StratifiedMap& stratified(const SamplerSpec& spec, std::uint32_t strata) {
        auto& map = maps[spec.text + "/" + std::to_string(strata)];
        if (!map)
            map = std::make_unique<measure::StratifiedMap>(
                target, strata, spec.by_radiance ? measure::Jitter::radiance : measure::Jitter::solid_angle);
        return *map;
    }
    std::unique_ptr<measure::Estimator> estimator(const SamplerSpec& spec, std::size_t material,
                                                  std::uint32_t samples) {
        if (spec.kind == SamplerKind::ris)
            return std::make_unique<measure::ResamplingEstimator>(candidates(spec, material), spec.candidates,
                                                                  samples);
        if (spec.kind == SamplerKind::strata)
            return std::make_unique<measure::StratifiedEstimator>(stratified(spec, samples));
        if (spec.kind == SamplerKind::file && table(spec, material).file->partner())
            throw SpecError("sampler '" + spec.text + "': its pdf is 0 where the MIS partner suffices; use mis(" +
                            spec.text + ", cosine)");
        if (spec.kind != SamplerKind::mis)
            return std::make_unique<measure::SingleEstimator>(single(spec, material, samples), samples);
        const std::vector<std::uint32_t> counts = divided(samples, spec);
        std::vector<measure::Share> shares;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const SamplerSpec& part = spec.parts[i];
            shares.push_back({&single(part, material, counts[i]), counts[i], part.automatic});
        }
        return std::make_unique<measure::MisEstimator>(shares, spec.power ? measure::Heuristic::power
                                                                          : measure::Heuristic::balance);
    }
    /// Adds up bytes and times of all tables of a sampler, each once.
    void sum_up(const SamplerSpec& spec, BuiltSampler& out) {
        std::set<const measure::LightSampler*> used;
        for (std::size_t material = 0; material < brdfs.size(); ++material) gather(spec, material, used);
        for (const measure::LightSampler* one : used) {
            out.bytes += one->bytes();
            out.making.seconds += one->making().seconds;
            out.making.shadow_rays += one->making().shadow_rays;
        }
    }
    void gather(const SamplerSpec& spec, std::size_t material, std::set<const measure::LightSampler*>& used) {
        if (spec.parts.empty() || spec.kind == SamplerKind::tiles) used.insert(&sampler(spec, material));
        else
            for (const SamplerSpec& part : spec.parts) gather(part, material, used);
    }
};

SamplerBuilder::SamplerBuilder(const builder::Target& target, std::vector<const input::Brdf*> brdfs,
                               std::string data, std::vector<builder::SceneNormal> normals,
                               const measure::Geometry* geometry, const std::vector<measure::ScenePoint>* points,
                               std::vector<std::string> at)
    : store_(new Store{target,
                       texels_of(builder::grid_of(target)),
                       std::move(brdfs),
                       std::move(data),
                       std::move(normals),
                       geometry,
                       points,
                       std::move(at),
                       {},
                       {},
                       {}}) {}

SamplerBuilder::~SamplerBuilder() = default;

BuiltSampler SamplerBuilder::build(const SamplerSpec& spec, std::uint32_t samples) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    BuiltSampler out;
    try {
        for (std::size_t material = 0; material < store_->brdfs.size(); ++material) {
            store_->estimators.push_back(store_->estimator(spec, material, samples));
            out.of_material.push_back(store_->estimators.back().get());
        }
        if (spec.kind == SamplerKind::strata) out.bytes = out.of_material.front()->bytes();
        else store_->sum_up(spec, out);
    } catch (const Failure&) {
        throw; // names its file
    } catch (const SpecError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw SpecError("sampler '" + spec.text + "': " + error.what());
    }
    out.build_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    out.ours = is_ours(spec);
    return out;
}

const measure::LightSampler& SamplerBuilder::single(const SamplerSpec& spec, std::size_t material,
                                                    std::uint32_t samples) {
    return store_->single(spec, material, samples);
}

} // namespace acdf::tools
