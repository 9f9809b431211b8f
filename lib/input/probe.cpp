#include "input/probe.h"

#include "input/detect.h"
#include "input/image.h"
#include "input/resample.h"
#include "input/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cmath>
#include <filesystem>
#include <new>

namespace acdf::input {
namespace {

struct BadCounts {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    std::size_t first = SIZE_MAX; // texel index

    void join(const BadCounts& o) {
        nan += o.nan;
        infinite += o.infinite;
        negative += o.negative;
        first = std::min(first, o.first);
    }
};

// Repairs the texels in [begin, end).
BadCounts repair(float* rgb, std::size_t begin, std::size_t end, BadCounts counts) {
    for (std::size_t i = begin; i < end; ++i) {
        bool nan = false, infinite = false, negative = false;
        for (float* v = rgb + 3 * i; v < rgb + 3 * i + 3; ++v) {
            if (*v >= 0.0f && std::isfinite(*v)) continue;
            if (std::isnan(*v)) nan = true;
            else if (std::isinf(*v)) infinite = true;
            else negative = true;
            *v = 0.0f;
        }
        if (!nan && !infinite && !negative) continue;
        ++(nan ? counts.nan : infinite ? counts.infinite : counts.negative);
        counts.first = std::min(counts.first, i);
    }
    return counts;
}

BadTexels repair_texels(Image& image, int threads) {
    const std::size_t texels = image.rgb.size() / 3, grain = 1 << 16;
    BadCounts counts;
    with_threads(threads, [&] {
        counts = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, texels, grain), BadCounts{},
            [&](const tbb::blocked_range<std::size_t>& range, const BadCounts& sum) {
                return repair(image.rgb.data(), range.begin(), range.end(), sum);
            },
            [](BadCounts a, const BadCounts& b) {
                a.join(b);
                return a;
            });
    });
    BadTexels bad{counts.nan, counts.infinite, counts.negative};
    if (counts.first != SIZE_MAX) {
        const auto width = static_cast<std::size_t>(image.width);
        bad.x = static_cast<int>(counts.first % width);
        bad.y = static_cast<int>(counts.first / width);
    }
    return bad;
}

void to_latlong(const Detected& detected, Image& image, int threads, Probe& probe) {
    const Map map{detected.layout, image.width, image.height};
    probe.width = latlong_width(map);
    probe.height = detected.layout == Layout::latlong ? image.height : probe.width / 2;
    probe.rgb = detected.layout == Layout::latlong
                    ? std::move(image.rgb)
                    : resample_to_latlong(map, std::move(image.rgb), probe.width, threads);
}

} // namespace

const char* to_string(Projection projection) {
    switch (projection) {
    case Projection::automatic:
        return "auto";
    case Projection::latlong:
        return "latlong";
    case Projection::angular:
        return "angular";
    case Projection::mirrorball:
        return "mirrorball";
    case Projection::cube_cross:
        return "cube-cross";
    case Projection::octahedral:
        return "octahedral";
    }
    return "unknown";
}

Probe read_probe(const std::string& path, const ProbeOptions& options) {
    Probe probe;
    probe.source_sha256 = file_sha256(path); // first: it tells missing files and folders apart
    probe.source_name = std::filesystem::path(path).filename().string();
    try {
        Image image = read_image(path, options.threads);
        probe.source_width = image.width;
        probe.source_height = image.height;
        probe.bad = repair_texels(image, options.threads);
        const Detected detected = detect_layout(path, image, options.projection);
        probe.projection = projection_of(detected.layout);
        probe.projection_reason = detected.reason;
        to_latlong(detected, image, options.threads, probe);
        probe.warnings = std::move(image.warnings);
    } catch (const std::bad_alloc&) {
        throw input_error(path, "there is not enough memory for its pixels; resize it");
    }
    return probe;
}

} // namespace acdf::input
