#include "build/indexed/environment.h"

#include "build/errors.h"
#include "build/text/options.h"
#include "compress/indexed/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>

#include <zlib.h>

namespace acdf::build {
namespace {

std::size_t map_count(const std::vector<MapAxis>& axes) {
    std::size_t count = 1;
    for (const MapAxis& axis : axes) count *= axis.coordinates.size();
    return count;
}

std::vector<std::uint32_t> counts_of(const std::vector<MapAxis>& axes) {
    std::vector<std::uint32_t> out;
    for (const MapAxis& axis : axes) out.push_back(static_cast<std::uint32_t>(axis.coordinates.size()));
    return out;
}

void check_maps(const std::vector<SunMap>& maps) {
    for (const SunMap& map : maps) {
        const compress::Target &one = *maps[0].target, &other = *map.target;
        if (one.columns != other.columns || one.rows != other.rows ||
            one.parameterization != other.parameterization)
            throw std::invalid_argument("maps differ in size or layout: " + std::to_string(one.columns) + "x" +
                                        std::to_string(one.rows) + " and " + std::to_string(other.columns) + "x" +
                                        std::to_string(other.rows));
        if (!compress::has_energy(other)) throw NoEnergy("a map without energy");
    }
}

compress::Description description_of(const std::vector<SunMap>& maps, const IndexedOptions& options) {
    const compress::Target& first = *maps[0].target;
    compress::Description out =
        compress::environment_description(first.columns, first.rows, first.parameterization);
    out.kind = ACDF_KIND_INDEXED;
    out.filter = options.target.filter;
    out.channels = options.target.channels;
    const compress::ChannelWeights& weights = options.target.weights;
    const double stored_weights[3] = {weights.r, weights.g, weights.b};
    std::copy(std::begin(stored_weights), std::end(stored_weights), out.channel_weights);
    for (const MapAxis& axis : options.axes)
        out.axes.push_back({axis.name, ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR,
                            static_cast<std::uint32_t>(axis.coordinates.size()), axis.coordinates.front(),
                            axis.coordinates.back()});
    out.total = 0.0;
    for (const SunMap& map : maps) out.total += map.target->total;
    out.shares.assign(maps.size(), 0.0f); // how many there are
    return out;
}

compress::Metadata metadata_of(const Source& source, const IndexedOptions& options, double mean, double worst) {
    return {{"tool", "acdf " ACDF_VERSION},
            {"fit.options", option_text(options)},
            {"source.name", source.name},
            {"source.sha256", source.sha256},
            {"source.projection", source.projection},
            {"accuracy.relative_variance", accuracy_text(mean)},
            {"accuracy.worst_relative_variance", accuracy_text(worst)}};
}

/// Chunks HALV and MAPS, and the rest of the file.
std::vector<std::uint8_t> stored(const compress::IndexedTree& tree, const IndexedOptions& options, const Suns& suns,
                                 compress::Description description, AcdfCodec codec) {
    std::vector<double> coordinates;
    for (const MapAxis& axis : options.axes)
        coordinates.insert(coordinates.end(), axis.coordinates.begin(), axis.coordinates.end());
    description.chunks = {
        {ACDF_CHUNK_MAPS, compress::maps_chunk(tree, coordinates, suns.of_maps, suns.any ? suns.roots + 1 : 0)}};
    return compress::store(tree.halvings, description, codec);
}

compress::IndexedTree fitted(const std::vector<SunMap>& maps, const Suns& suns, const IndexedOptions& options,
                             const compress::Description& description, const Progress& progress) {
    compress::IndexedTree none;
    none.halvings.axes = {-1};
    none.rows.resize(maps.size());
    // Both chunks may end in padding that they have not here.
    const std::uint64_t others =
        stored(none, options, suns, description, ACDF_CODEC_NONE).size() + 2 * ACDF_ALIGNMENT;
    if (options.budget < others + ACDF_ALIGNMENT)
        throw std::runtime_error("a size of " + std::to_string(options.budget) +
                                 " bytes is out of reach; the least that can be had is " +
                                 std::to_string(others + ACDF_ALIGNMENT));
    std::vector<compress::IndexedMap> fit;
    for (std::size_t i = 0; i < maps.size(); ++i)
        fit.push_back({maps[i].target, suns.rest[i], 1.0 - double{suns.of_maps[i].sun_share}});
    return compress::fit_indexed(fit, options.budget - others, [&](double share) {
        if (progress) progress(0.1 + 0.7 * share, "fitting");
    });
}

/// Zeros stay.
std::vector<SunDirection> unit_vectors(std::vector<SunDirection> directions) {
    for (SunDirection& d : directions) {
        const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (double& coordinate : d) coordinate = length > 0.0 ? coordinate / length : 0.0;
    }
    return directions;
}

/// Of coordinates too many to be spelled.
std::string checksum_of(const std::vector<SunDirection>& suns) {
    char text[16];
    const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(suns.data()), suns.size() * sizeof suns[0]);
    std::snprintf(text, sizeof text, "%08lx", static_cast<unsigned long>(crc));
    return std::string("crc32:") + text;
}

} // namespace

void check(const IndexedOptions& options, std::size_t maps) {
    if (options.axes.empty() || options.axes.size() > ACDF_MOST_INDEXED_AXES)
        throw OptionError("maps have one to three axes");
    std::set<std::string> names = {"phi", "theta", "u", "v"};
    for (const MapAxis& axis : options.axes) {
        if (axis.name.empty() || axis.name.size() > 15 || !names.insert(axis.name).second)
            throw OptionError("axis '" + axis.name +
                              "': axes have different names of 1 to 15 bytes, none of phi, theta, u and v");
        const std::vector<double>& at = axis.coordinates;
        if (at.size() < 2) throw OptionError("axis " + axis.name + " needs two coordinates or more");
        for (std::size_t i = 0; i < at.size(); ++i)
            if (!std::isfinite(at[i]) || (i > 0 && !(at[i] > at[i - 1])))
                throw OptionError("the coordinates of axis " + axis.name + " do not rise");
    }
    if (map_count(options.axes) != maps)
        throw OptionError("there are " + std::to_string(maps) + " maps, and the axes have " +
                          std::to_string(map_count(options.axes)));
    if (!options.suns.empty() && (!options.sun || options.suns.size() != maps))
        throw OptionError("there are " + std::to_string(maps) + " maps and " + std::to_string(options.suns.size()) +
                          " suns" + (options.sun ? "" : ", and the sun is to be stored as any other light"));
    for (const SunDirection& sun : options.suns)
        for (const double coordinate : sun)
            if (!(std::fabs(coordinate) <= 1e6))
                throw OptionError("the direction of a sun is not finite or above 1e6");
}

std::string option_text(const IndexedOptions& options) {
    std::string text = options.reading + target_text(options.target) + codec_text(options.codec);
    for (const MapAxis& axis : options.axes) {
        text += "--axis " + axis.name + "=";
        for (std::size_t i = 0; i < axis.coordinates.size(); ++i)
            text += (i ? "," : "") + option_number(axis.coordinates[i]);
        text += " ";
    }
    if (!options.suns.empty()) text += "--sun " + checksum_of(options.suns) + " ";
    else if (!options.sun) text += "--no-sun ";
    return text + "--budget " + std::to_string(options.budget);
}

IndexedEnvironmentFile build_indexed(const std::vector<SunMap>& maps, const Source& source,
                                     const IndexedOptions& options, const Progress& progress) {
    check(options, maps.size());
    check_maps(maps);
    const auto tell = [&](double share, const char* what) {
        if (progress) progress(share, what);
    };
    const std::vector<SunDirection> given = unit_vectors(options.suns);
    Suns suns =
        options.sun ? find_suns(maps, counts_of(options.axes), given.empty() ? nullptr : &given) : no_suns(maps);
    compress::Description description = description_of(maps, options);
    for (std::size_t i = 0; i < maps.size(); ++i)
        suns.of_maps[i].share = compress::positive_float(maps[i].target->total / description.total);
    tell(0.1, "fitting");
    IndexedEnvironmentFile out;
    description.metadata = metadata_of(source, options, 0.0, 0.0);
    const compress::IndexedTree tree = fitted(maps, suns, options, description, progress);
    suns.rest.clear();
    out.cells = tree.halvings.leaves();
    out.splits = static_cast<std::size_t>(std::count(tree.has_codes.begin(), tree.has_codes.end(), true));
    for (const AcdfMap& map : suns.of_maps) out.suns += map.sun_share > 0.0f;

    const std::vector<std::uint8_t> bytes = stored(tree, options, suns, description, ACDF_CODEC_NONE);
    File file;
    IndexedEnvironment stored_maps;
    Status status = File::from_memory(bytes.data(), bytes.size(), file);
    if (status.ok()) status = IndexedEnvironment::open(file, stored_maps);
    if (!status.ok()) throw std::logic_error(std::string("the file just made is not accepted: ") + status.message);
    double logarithms = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        double at[ACDF_MOST_INDEXED_AXES];
        std::size_t rest = i;
        for (std::size_t axis = options.axes.size(); axis-- > 0;) {
            const std::vector<double>& coordinates = options.axes[axis].coordinates;
            at[axis] = coordinates[rest % coordinates.size()];
            rest /= coordinates.size();
        }
        out.accuracy.push_back(measure_mixed(stored_maps.at(at), maps[i]));
        worst = std::max(worst, out.accuracy[i].relative_variance);
        logarithms += std::log(std::max(out.accuracy[i].relative_variance, 1e-30));
        tell(0.8 + 0.2 * double(i) / double(maps.size()), "measuring");
    }
    out.mean_variance = std::exp(logarithms / double(maps.size()));
    description.metadata = metadata_of(source, options, out.mean_variance, worst);
    out.bytes = stored(tree, options, suns, description, options.codec);
    tell(1.0, "measuring");
    return out;
}

} // namespace acdf::build
