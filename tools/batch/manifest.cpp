#include "tools/batch/manifest.h"

#include "reader/utf8.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <set>

namespace acdf::tools {
namespace {

using Json = nlohmann::ordered_json;

/// What is wrong with a line.
struct LineError {
    std::string what;
};

constexpr std::size_t longest_line = std::size_t{1} << 20;

[[noreturn]] void fail(const std::string& what) { throw LineError{what}; }

/// `text` is UTF-8. Throws LineError, also for keys that come twice and values in values in values.
Json parse_line(std::string_view text) {
    std::vector<std::set<std::string>> keys; // of the objects that are open
    const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
        if (depth > 8) fail("is nested too deeply");
        if (event == Json::parse_event_t::object_start) keys.emplace_back();
        if (event == Json::parse_event_t::object_end) keys.pop_back();
        if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
            fail("has '" + value.get<std::string>() + "' twice");
        return true;
    };
    try {
        return Json::parse(text.begin(), text.end(), watch);
    } catch (const Json::parse_error& error) {
        fail("is not JSON: error at column " + std::to_string(error.byte) +
             "; a line is one object such as {\"source\": \"sky.exr\"}");
    } catch (const Json::exception&) {
        fail("has a number that is out of range");
    }
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string text_of(const Json& value, const char* key) {
    if (!value.is_string()) fail(std::string("'") + key + "' must be a string, not " + value.type_name());
    std::string text = value.get<std::string>();
    if (text.empty()) fail(std::string("'") + key + "' is empty");
    if (std::any_of(text.begin(), text.end(), is_control))
        fail(std::string("'") + key + "' has a control character");
    return text;
}

/// A file, or the six faces of a cube as one source (lib/input/probe/source.h).
std::string source_of(const Json& value) {
    constexpr std::size_t faces = 6;
    if (!value.is_array()) return text_of(value, "source");
    if (value.size() != faces) fail("'source' must be one file, or six: the faces of a cube");
    std::string joined;
    for (const Json& item : value) {
        const std::string file = text_of(item, "source");
        if (file.find(',') != std::string::npos) fail("'source' has a face with a comma in its name");
        joined += (joined.empty() ? "" : ",") + file;
    }
    return joined;
}

/// Files and sequences.
std::vector<std::string> maps_of(const Json& value) {
    if (!value.is_array() || value.empty())
        fail("'maps' must be an array of files, or of sequences: [\"day.####.exr\"]");
    std::vector<std::string> maps;
    for (const Json& item : value) maps.push_back(text_of(item, "maps"));
    return maps;
}

/// Adds {"budget": "64KiB"} as "--budget=64KiB", and {"no-sharing": true} as "--no-sharing".
void add_option(const std::string& name, const Json& value, std::vector<std::string>& options) {
    if (value.is_string()) options.push_back("--" + name + "=" + text_of(value, name.c_str()));
    else if (value.is_number()) options.push_back("--" + name + "=" + value.dump());
    else if (value.is_boolean() && value.get<bool>()) options.push_back("--" + name);
    else if (!value.is_boolean())
        fail("the value of option '" + name + "' must be a string, a number or true, not " + value.type_name());
}

/// An array of strings stands for an option that is given several times.
std::vector<std::string> options_of_object(const Json& object) {
    std::vector<std::string> options;
    for (const auto& [name, value] : object.items()) {
        if (std::any_of(name.begin(), name.end(), is_control))
            fail("the name of an option has a control character");
        if (name.empty() || name[0] == '-' || name.find_first_of("= \t") != std::string::npos)
            fail("'" + name + "' is not the name of an option; write it without dashes");
        const bool several = value.is_array() && std::all_of(value.begin(), value.end(),
                                                             [](const Json& each) { return each.is_string(); });
        if (!several) add_option(name, value, options);
        else
            for (const Json& each : value) add_option(name, each, options);
    }
    return options;
}

std::vector<std::string> options_of(const Json& value) {
    if (value.is_object()) return options_of_object(value);
    if (!value.is_array())
        fail(std::string(
                 "'options' must be an object such as {\"budget\": \"64KiB\"}, or an array of strings, not ") +
             value.type_name());
    std::vector<std::string> options;
    for (const Json& item : value) options.push_back(text_of(item, "options"));
    return options;
}

ManifestJob job_of(const Json& object) {
    if (!object.is_object()) fail(std::string("must be an object, not ") + object.type_name());
    ManifestJob job;
    for (const auto& [key, value] : object.items()) {
        if (key == "source") job.source = source_of(value);
        else if (key == "maps") job.maps = maps_of(value);
        else if (key == "output") job.output = text_of(value, "output");
        else if (key == "options") job.options = options_of(value);
        else if (key == "kind") {
            const std::string name = text_of(value, "kind");
            job.kind = find_kind(name);
            if (!job.kind) fail("kind '" + name + "' is none of env, local and brdf");
        } else {
            fail("has an unknown key '" + key + "'; there are source, maps, kind, options and output");
        }
    }
    if (job.source.empty() && job.maps.empty()) fail("has no 'source'");
    if (!job.source.empty() && !job.maps.empty()) fail("has 'source' and 'maps'; give one");
    if (!job.maps.empty() && job.output.empty()) fail("has no 'output', which several maps need");
    return job;
}

ManifestJob read_line(std::string_view text) {
    if (text.size() > longest_line) fail("is longer than 1 MiB");
    if (const std::size_t at = find_non_utf8(text); at != std::string_view::npos)
        fail("is not UTF-8 at column " + std::to_string(at + 1));
    return job_of(parse_line(text));
}

/// The first line of `text`, which loses it.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    return line;
}

} // namespace

const JobKind* find_kind(std::string_view name) {
    for (const JobKind& kind : job_kinds)
        if (name == kind.name) return &kind;
    return nullptr;
}

Manifest parse_manifest(std::string_view text) {
    text = without_byte_order_mark(text);
    Manifest manifest;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::string_view line = take_line(text);
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        try {
            manifest.jobs.push_back(read_line(line));
            manifest.jobs.back().line = number;
        } catch (const LineError& error) {
            manifest.errors.push_back({number, error.what});
        }
    }
    return manifest;
}

std::size_t find_non_utf8(std::string_view text) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t n = utf8_sequence(bytes + i, text.size() - i);
        if (n == 0) return i;
        i += n;
    }
    return std::string_view::npos;
}

} // namespace acdf::tools
