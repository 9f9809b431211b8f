#include "input/mesh/instances.h"

#include "input/error.h"
#include "input/file_name.h"
#include "input/sha256.h"
#include "input/text_lines.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace acdf::input {
namespace {

constexpr const char* form = "instance; a list has lines of twelve numbers and a mesh's file";

/// What is left of a line, without blanks at its ends.
std::string rest_of(const char* at, const char* end) {
    while (at != end && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r')) --end;
    return {at, end};
}

/// Numbers of a usual size, and no mesh becomes flat.
bool is_sound(const Placement& placement) {
    for (const auto& row : placement.rows)
        for (const double x : row)
            if (!(std::abs(x) <= 1e15)) return false;
    return std::abs(placement.determinant()) >= 1e-30;
}

} // namespace

bool is_instances(const std::string& path) { return lower_extension(path) == ".instances"; }

std::vector<Instances> read_instances(const std::string& path) {
    std::vector<Instances> out;
    for_each_line(path, form, [&](const TextLine& line) {
        const auto fail = [&](const std::string& what) {
            return input_error(path, "line " + std::to_string(line.number) + " " + what);
        };
        if (is_blank(line.begin, line.end)) return;
        Placement placement;
        double numbers[12];
        const char* at = line.begin;
        const int count = read_numbers(at, line.end, numbers, 12);
        const std::string name = rest_of(at, line.end);
        if (count != 12 || name.empty()) throw fail(std::string("is not an ") + form);
        for (std::size_t i = 0; i < 12; ++i) placement.rows[i / 4][i % 4] = numbers[i];
        if (!is_sound(placement)) throw fail("makes its mesh flat, or larger than 1e15");
        const std::string mesh = (std::filesystem::path(path).parent_path() / name).string();
        if (const std::string kind = lower_extension(mesh); kind != ".obj" && kind != ".ply")
            throw fail("does not name a mesh: .obj or .ply");
        auto same = std::find_if(out.begin(), out.end(), [&](const Instances& i) { return i.mesh == mesh; });
        if (same == out.end()) same = out.insert(out.end(), Instances{mesh, {}});
        same->placements.push_back(placement);
    });
    if (out.empty()) throw input_error(path, "it lists no mesh");
    return out;
}

std::vector<std::string> scene_files(const std::string& path) {
    std::vector<std::string> out{path};
    if (is_instances(path))
        for (const Instances& instances : read_instances(path)) out.push_back(instances.mesh);
    return out;
}

std::uint64_t scene_bytes(const std::string& path) {
    std::vector<Instances> all{{path, {Placement{}}}};
    std::uint64_t sum = 0;
    try {
        if (is_instances(path)) all = read_instances(path);
    } catch (const Error&) {
        return 0;
    }
    for (const Instances& instances : all) {
        std::error_code error;
        const std::uintmax_t bytes = std::filesystem::file_size(instances.mesh, error);
        if (!error) sum += bytes * instances.placements.size();
    }
    return sum;
}

std::string scene_sha256(const std::string& path) {
    if (!is_instances(path)) return file_sha256(path);
    std::string digits;
    for (const std::string& file : scene_files(path)) digits += file_sha256(file) + "\n";
    return text_sha256(digits, path);
}

} // namespace acdf::input
