// What is compared, as short texts: "local:1MB", "ris:32", "mis(local:1MB,cosine)".
#pragma once

#include "tools/render/scene_error.h"

#include <acdf/builder.h>

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

enum class SamplerKind {
    full_cdf, ///< full-cdf: the probe's full-resolution CDF, directions below the horizon sampled in vain
    cosine,   ///< cosine: of the hemisphere
    tiles,    ///< tiles:32x16: of the probe, weighted at each point, the full CDF inside; tiles:12x12(brdf:64KiB):
              ///< weighted by the BRDF, too
    visibility_cache, ///< visibility-cache:32x16: tiles, also weighted by how much of them the nearest cache points
                      ///< see
    portals,          ///< portals: the light in the scene's portals; portals:uniform: over their solid angle
    env,              ///< env:64KiB: what `acdf env` makes
    local,            ///< local:1MB: what `acdf local` makes
    visibility,       ///< visibility:4MB: what `acdf local --visibility` makes for the scene
    visibility_portals, ///< visibility-portals:4MB: the same with the scene's portals
    learned,            ///< learned:4MB: the same from shadow rays of the picture, four a point; --mis cosine:
                        ///< for what samples of the cosine leave over
    brdf,               ///< brdf:64KiB: what `acdf brdf` makes, one for each BRDF of the scene
    brdf_table,         ///< brdf-table[:centre]: the full table of the paper, repaired or as described
    ggx,                ///< ggx:0.1: normals of a lobe visible to the viewer
    alias,              ///< alias: table over texels
    hierarchical,       ///< hierarchical: warping through a quadtree
    downsampled,        ///< downsampled:64x32: a full CDF of means
    compensated,        ///< compensated: a CDF of what exceeds the mean radiance, in mis(...) alone
    strata,             ///< strata[:radiance]: jittered in a stratified map, Agarwal et al. 2003
    ris,     ///< ris:32: resampled candidates of the full CDF; ris:32(local:1MB,brdf:64KiB): of both, half each
    mis,     ///< mis(A,B), mis-power(A,B): balance or power heuristic; mis-compensated is
             ///< mis(compensated,cosine)
    ideal,   ///< ideal: light times cosine on all texels, made at each point; --mis cosine: filled up for it
    file,    ///< file:my.acdf: any environment, local environment or BRDF file
    product, ///< product(local:1MB,brdf:64KiB), product:32(file:sky.acdf,ggx:0.1): light times BRDF, in 32 parts
    warp,    ///< warp(local:1MB,brdf:64KiB): the light's numbers bent towards the BRDF, Hart et al. 2020
};

struct SamplerSpec {
    SamplerKind kind = SamplerKind::full_cdf;
    std::string text;                    ///< as given: its name in tables
    std::uint64_t bytes = 0;             ///< env, local, visibility, learned, brdf: the budget
    std::uint32_t columns = 0, rows = 0; ///< tiles, visibility_cache, downsampled
    std::uint32_t candidates = 0;        ///< ris
    double alpha = 0.0;                  ///< ggx
    bool by_radiance = false;            ///< strata: not by solid angle
    bool uniform = false;                ///< portals: no light
    bool centre = false;                 ///< brdf-table as described
    bool power = false;                  ///< mis: power heuristic
    builder::Partner mis;                ///< env, local, visibility, learned, ideal: that it is made for
    bool of_scene = false;               ///< env, local: made for the normals that the camera sees
    bool automatic = false;              ///< a part of mis: gives as many samples as it recommends itself
    std::string path;                    ///< file
    std::uint32_t divisions = 0;         ///< product: parts of the sphere; 0: as many as the samples pay for
    std::vector<SamplerSpec> parts; ///< mis: two or more; product, warp: light and BRDF; ris: two; tiles: a BRDF
    std::vector<double> shares;     ///< mis: of the samples; their sum is 1
};

/// `mis(4*local:1MB,cosine)` gives the first part four times as many samples as the second, `mis(auto:local:1MB
/// --mis cosine,cosine)` as many as the file recommends at each point. Throws SpecError.
SamplerSpec parse_sampler(const std::string& text);

/// Letters, digits and hyphens: for file names. Distinct texts may have the same.
std::string file_stem(const SamplerSpec& spec);

/// How `samples` are divided: at least one each, by largest remainders. Throws SpecError where there are fewer
/// samples than parts.
std::vector<std::uint32_t> divided(std::uint32_t samples, const SamplerSpec& spec);

} // namespace acdf::tools
