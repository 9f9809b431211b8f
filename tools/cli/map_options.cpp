#include "tools/cli/map_options.h"

#include "tools/cli/built.h"
#include "tools/cli/json.h"
#include "tools/cli/sequence.h"
#include "tools/commands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace acdf::tools {
namespace {

std::vector<double> numbers_of(const std::string& text, const char* option) {
    std::vector<double> out;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        char* rest = nullptr;
        const double value = std::strtod(word.c_str(), &rest);
        if (word.empty() || *rest != 0 || !std::isfinite(value))
            throw CLI::ValidationError(option, "'" + word + "' is no number");
        out.push_back(value);
        begin = end + 1;
    }
    return out;
}

} // namespace

void MapOptions::add(CLI::App& command) {
    const char* group = "Several maps in one file";
    command
        .add_option(
            "--axis", axis_texts_,
            "An axis of the maps, with the coordinate of each: time=6,9,12. All maps become one file, of one "
            "size and layout. With several axes (up to three, each by --axis) the maps come in rows, the "
            "last axis fastest. A sequence sky.####.exr has the axis frame by itself")
        ->option_text("NAME=V,V,...")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(group);
    command
        .add_option(
            "--sun", sun_texts_,
            "Where the sun of each map is, in the frame of directions: once for every map, 0,0,0 where it is "
            "not up. By default a small region that is much brighter than all else is looked for. A cone "
            "stands for it, which moves between maps")
        ->option_text("X,Y,Z")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(group);
    command.add_flag("--no-sun", no_sun_, "Store a sun as any other light: between maps there are two of it")
        ->group(group);
}

bool MapOptions::given(const std::vector<std::string>& sources) const {
    return !axis_texts_.empty() || std::any_of(sources.begin(), sources.end(), is_sequence);
}

void MapOptions::parse_axes() {
    for (const std::string& text : axis_texts_) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals > 15)
            throw CLI::ValidationError("--axis", "needs a name of up to 15 letters and values: time=6,9,12");
        axes_.push_back({text.substr(0, equals), numbers_of(text.substr(equals + 1), "--axis")});
    }
    if (axes_.size() > ACDF_MOST_INDEXED_AXES) throw CLI::ValidationError("--axis", "is for up to three axes");
}

void MapOptions::add_frames(const std::string& sequence) {
    const bool named = !axes_.empty();
    if (!named) axes_.push_back({"frame", {}});
    for (const Frame& frame : frames_of(sequence)) {
        files_.push_back(frame.file);
        if (!named) axes_[0].coordinates.push_back(double(frame.number));
    }
}

void MapOptions::take(const std::vector<std::string>& sources) {
    parse_axes();
    for (const std::string& source : sources)
        if (is_sequence(source)) add_frames(source);
        else files_.push_back(source);
    std::size_t count = 1;
    for (const builder::MapAxis& axis : axes_) count *= axis.coordinates.size();
    if (count != files_.size())
        throw CLI::ValidationError("--axis", "makes " + std::to_string(count) + " maps, and " +
                                                 std::to_string(files_.size()) + " are given");
    if (!sun_texts_.empty() && (no_sun_ || sun_texts_.size() != files_.size()))
        throw CLI::ValidationError("--sun", "is given once for each map, and without --no-sun");
    for (const std::string& text : sun_texts_) {
        const std::vector<double> d = numbers_of(text, "--sun");
        if (d.size() != 3) throw CLI::ValidationError("--sun", "needs three numbers such as 0.6,0,0.8");
        suns_.push_back({d[0], d[1], d[2]});
    }
}

builder::IndexedOptions MapOptions::options(const input::ProbeOptions& reading,
                                            const builder::EnvironmentOptions& environment) const {
    builder::IndexedOptions out;
    out.target = environment.target;
    out.goal = environment.goal;
    out.codec = environment.codec;
    out.axes = axes_;
    out.sun = !no_sun_;
    out.suns = suns_;
    out.source.reading = reading_text(reading);
    return out;
}

LoadedMaps MapOptions::load(const input::ProbeOptions& reading, const builder::TargetOptions& target,
                            const Note& note, const build::Progress& progress) const {
    LoadedMaps out;
    out.maps.resize(files_.size());
    out.source.reading = reading_text(reading);
    std::vector<std::string> digests;
    std::set<std::string> notes; // most hold for all maps
    const Note once = [&](const std::string& text) {
        if (notes.insert(text).second) note(text);
    };
    for (std::size_t i = 0; i < files_.size(); ++i) {
        const ProbeTarget loaded = load_map(files_[i], reading, target, once, out.maps[i].texels);
        out.maps[i].fitted = loaded.target;
        out.source.projection = input::to_string(loaded.probe.projection);
        digests.push_back(loaded.probe.source_sha256);
        if (i == 0) out.source.name = loaded.probe.source_name;
        if (progress) progress(double(i + 1) / double(files_.size()), "reading");
    }
    out.source.sha256 = sha256_of_maps(digests, files_[0]);
    return out;
}

Converted MapOptions::convert(const input::ProbeOptions& reading, const builder::EnvironmentOptions& environment,
                              const Listener& listener) const {
    constexpr double kReading = 0.2; // of the time, about
    const LoadedMaps loaded = load(reading, environment.target, listener.note, [&](double share, const char* what) {
        if (listener.progress) listener.progress(kReading * share, what);
    });
    builder::IndexedOptions all = options(reading, environment);
    all.source = loaded.source;
    const build::Progress building = [&](double share, const char* what) {
        if (listener.progress) listener.progress(kReading + (1.0 - kReading) * share, what);
    };
    builder::IndexedFile made;
    require_built(files_[0], builder::indexed(loaded.maps, all, made, told(building)));
    double worst = 0.0;
    nlohmann::ordered_json each = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < made.accuracy.size(); ++i) {
        worst = std::max(worst, made.accuracy[i].relative_variance);
        each.push_back({{"source", files_[i]}, {"relative_variance", made.accuracy[i].relative_variance}});
    }
    const nlohmann::ordered_json report = {{"source", files_[0]},
                                           {"maps", each},
                                           {"suns", made.suns},
                                           {"splits", made.splits},
                                           {"cells", made.cells},
                                           {"bytes", made.bytes.size()},
                                           {"relative_variance", made.mean_variance},
                                           {"worst_relative_variance", worst}};
    char summary[200];
    std::snprintf(summary, sizeof summary,
                  "%zu maps, %zu with a sun, %zu cells, relative variance %.4g (geometric mean), worst %.4g",
                  files_.size(), made.suns, made.cells, made.mean_variance, worst);
    return {std::move(made.bytes), made.mean_variance, json_text(report), summary};
}

} // namespace acdf::tools
