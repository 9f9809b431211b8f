#include "tools/batch/jobs.h"

#include "input/brdf/models.h"
#include "input/file_name.h"
#include "input/probe/source.h"
#include "tools/cli/file_input.h"
#include "tools/cli/sequence.h"
#include "tools/commands.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>

#include <fnmatch.h>
#include <glob.h>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

// What folders are searched for: formats of radiance, not those of previews, which a manifest may name.
constexpr std::array probe_extensions = {".exr", ".hdr", ".pfm", ".tif", ".tiff", ".tx"};
constexpr std::array brdf_extensions = {".binary", ".bsdf"};

template <std::size_t N>
bool is_one_of(const std::array<const char*, N>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

/// A picture of `acdf render`: it lies beside the report, and as a .png as well. It is no probe, whatever its
/// shape.
bool is_rendering(const fs::path& path) {
    std::error_code ignored;
    return input::lower_extension(path) == ".exr" && fs::exists(path.parent_path() / "render.json", ignored) &&
           fs::exists(fs::path(path).replace_extension(".png"), ignored);
}

/// A source whose paths are relative to a folder.
std::string below(const fs::path& folder, const std::string& source) {
    return input::with_paths(source, [&](const std::string& file) { return (folder / file).string(); });
}

class Collector {
public:
    explicit Collector(const BatchDefaults& defaults) : defaults_(defaults) {}

    void add_input(const std::string& input) {
        std::error_code error;
        if (input == "-" || input::lower_extension(input) == ".jsonl") add_manifest(input);
        else if (fs::is_directory(input, error)) add_folder(input);
        else if (!fs::exists(input, error) && input.find_first_of("*?[") != std::string::npos) add_glob(input);
        else add_file(input, input);
    }

    BatchJobs take() { return std::move(out_); }

private:
    /// A job for each kind that the source becomes by default. `name`: what the output is called after.
    void add_source(const std::string& source, const fs::path& name) {
        const JobKind* brdf = find_kind("brdf");
        if (is_one_of(brdf_extensions, input::lower_extension(source))) return add(source, brdf, name);
        for (const JobKind* kind : defaults_.probe_kinds) add(source, kind, name);
    }

    void add(const std::string& source, const JobKind* kind, const fs::path& name) {
        BatchJob job;
        job.origin = source;
        job.kind = kind;
        job.source = source;
        job.options = defaults_.options(*kind, name.string());
        job.output = fs::path(name).replace_extension().string() + kind->suffix;
        out_.jobs.push_back(std::move(job));
    }

    void add_file(const std::string& path, const std::string& origin) {
        if (input::lower_extension(path) == ".npy")
            out_.errors.push_back(origin + ": may be a BRDF or a table; name it in a manifest, with its kind");
        else add_source(path, fs::path(path).filename());
    }

    void add_folder(const std::string& folder) {
        const std::size_t before = out_.jobs.size();
        out_.folders.push_back(folder);
        std::vector<fs::path> found;
        std::error_code error;
        fs::recursive_directory_iterator i(folder, error), end;
        for (; !error && i != end; i.increment(error)) {
            const fs::path& path = i->path();
            std::error_code ignored; // a link in a circle is a name like others
            const bool hidden = path.filename().string().front() == '.', directory = i->is_directory(ignored);
            if (directory && hidden) i.disable_recursion_pending();
            else if (directory && !i->is_symlink(ignored)) out_.folders.push_back(path.string());
            const std::string extension = input::lower_extension(path);
            if (!directory && !hidden && !is_rendering(path) &&
                (is_one_of(probe_extensions, extension) || is_one_of(brdf_extensions, extension)))
                found.push_back(path);
        }
        if (error) out_.errors.push_back(folder + ": cannot be searched: " + error.message());
        std::sort(found.begin(), found.end()); // folders have no order of their own
        for (const fs::path& path : found) add_source(path.string(), path.lexically_relative(folder));
        if (!error && out_.jobs.size() == before)
            out_.errors.push_back(folder + ": has no probe (" + list(probe_extensions) + ") and no BRDF (" +
                                  list(brdf_extensions) + ") in it or below");
    }

    void add_glob(const std::string& pattern) {
        glob_t matches = {};
        const int code = glob(pattern.c_str(), 0, nullptr, &matches);
        for (std::size_t i = 0; code == 0 && i < matches.gl_pathc; ++i) {
            const std::string path = matches.gl_pathv[i];
            std::error_code error;
            if (fs::is_directory(path, error)) add_folder(path);
            else add_file(path, path);
        }
        globfree(&matches);
        if (code != 0) out_.errors.push_back(pattern + ": matches no file; quote globs or leave them to the shell");
    }

    void add_manifest(const std::string& path) {
        const std::string name = path == "-" ? "stdin" : path;
        const std::vector<std::uint8_t> bytes = read_bytes(path);
        if (path != "-") out_.files.push_back(path);
        const Manifest manifest = parse_manifest({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        for (const ManifestError& error : manifest.errors)
            out_.errors.push_back(name + ":" + std::to_string(error.line) + ": " + error.what);
        const fs::path base = path == "-" ? fs::path() : fs::path(path).parent_path();
        for (const ManifestJob& line : manifest.jobs) add_line(line, name, base);
        if (manifest.jobs.empty() && manifest.errors.empty()) out_.errors.push_back(name + ": has no jobs");
    }

    void add_line(const ManifestJob& line, const std::string& name, const fs::path& base) {
        BatchJob job;
        job.origin = name + ":" + std::to_string(line.line);
        job.base = base.string();
        const std::string extension = input::lower_extension(line.source);
        const bool model = input::is_model(line.source);
        if (!line.kind && extension == ".npy") {
            out_.errors.push_back(job.origin + ": " + line.source + " is a BRDF only if 'kind' says so");
            return;
        }
        job.kind = line.kind                                        ? line.kind
                   : !line.maps.empty()                             ? find_kind("env")
                   : model || is_one_of(brdf_extensions, extension) ? find_kind("brdf")
                                                                    : defaults_.probe_kinds.front();
        job.options = line.options ? *line.options : defaults_.options(*job.kind, line.source);
        job.output = line.output.empty() ? stem_of(line.source) + job.kind->suffix : line.output;
        try {
            if (!line.maps.empty()) add_maps(line.maps, base, job);
            else job.source = model && job.kind == find_kind("brdf") ? line.source : below(base, line.source);
        } catch (const std::exception& error) {
            out_.errors.push_back(job.origin + ": " + error.what());
            return;
        }
        out_.jobs.push_back(std::move(job));
    }

    static std::string stem_of(const std::string& source) {
        return input::is_model(source)
                   ? source
                   : fs::path(input::probe_files(source)[0]).filename().replace_extension().string();
    }

    /// Sequences become their files, and an axis of these, unless there are others.
    static void add_maps(const std::vector<std::string>& maps, const fs::path& base, BatchJob& job) {
        const auto is_axis = [](const std::string& option) { return option.rfind("--axis", 0) == 0; };
        std::string frames;
        for (const std::string& map : maps) {
            const std::string path = (base / map).string();
            if (!is_sequence(path)) {
                job.maps.push_back(path);
                continue;
            }
            for (const Frame& frame : frames_of(path)) {
                job.maps.push_back(frame.file);
                frames += (frames.empty() ? "" : ",") + std::to_string(frame.number);
            }
        }
        if (!frames.empty() && std::none_of(job.options.begin(), job.options.end(), is_axis))
            job.options.push_back("--axis=frame=" + frames);
        job.source = job.maps[0];
    }

    template <std::size_t N>
    static std::string list(const std::array<const char*, N>& names) {
        std::string text;
        for (const char* name : names) text += (text.empty() ? "" : " ") + std::string(name);
        return text;
    }

    const BatchDefaults& defaults_;
    BatchJobs out_;
};

/// Adds the size of a file, or reports what is wrong with it.
std::string add_bytes(const std::string& path, std::uint64_t& bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) return "there is no file " + path;
    if (status.type() == fs::file_type::none) return path + ": " + error.message();
    if (status.type() == fs::file_type::directory) return path + " is a folder, not a file";
    if (status.type() != fs::file_type::regular) return path + " is not a regular file";
    bytes += fs::file_size(path, error);
    return error ? path + ": " + error.message() : "";
}

/// Adds the size of the source, or reports what is wrong with it.
std::string check_source(BatchJob& job) {
    if (find_non_utf8(job.source) != std::string::npos)
        return "the name of the source is not UTF-8, which files store it in; rename it";
    job.bytes = 0;
    for (const std::string& file : job.files())
        if (std::string what = add_bytes(file, job.bytes); !what.empty()) return what;
    return "";
}

/// Symbolic links below the output folder could lead anywhere.
std::string check_links(const fs::path& folder, const std::string& output) {
    fs::path at = folder;
    for (const fs::path& part : fs::path(output)) {
        at /= part;
        std::error_code error;
        if (fs::is_symlink(fs::symlink_status(at, error)))
            return "the output " + output + " goes through the symbolic link " + at.string();
        if (fs::is_directory(at, error)) continue;
        if (fs::exists(at, error) && at != folder / output)
            return "the output " + output + " is in " + at.string() + ", which is not a folder";
        return "";
    }
    return "the output " + output + " is a folder already";
}

std::string check_output(const std::string& folder, BatchJob& job) {
    if (std::string what = output_name_error(job.output); !what.empty())
        return "the output '" + job.output + "' " + what;
    job.output = fs::path(job.output).lexically_normal().string();
    return check_links(folder, job.output);
}

/// Of two jobs with the same output.
std::string collision(const BatchJob& first, const BatchJob& job) {
    const bool same = job.kind == first.kind && job.options == first.options && job.maps == first.maps &&
                      fs::absolute(job.source).lexically_normal() == fs::absolute(first.source).lexically_normal();
    if (same && job.origin == first.origin) return job.origin + ": is given twice; give it once";
    if (same) return job.origin + ": is the same job as " + first.origin + "; leave one of them out";
    return job.origin + ": writes " + job.output + ", as does " + first.origin +
           "; give one of them another name in a manifest";
}

void check_duplicates(const std::string& folder, BatchJobs& jobs) {
    std::map<std::string, const BatchJob*> by_output;
    for (const BatchJob& job : jobs.jobs) {
        const auto [first, is_new] = by_output.emplace(job.output, &job);
        if (!is_new) jobs.errors.push_back(collision(*first->second, job));
    }
    std::map<std::string, const BatchJob*> by_source;
    for (const BatchJob& job : jobs.jobs)
        for (const std::string& file : job.maps.empty() ? std::vector<std::string>{job.source} : job.maps)
            by_source.emplace(fs::absolute(file).lexically_normal(), &job);
    for (const BatchJob& job : jobs.jobs) {
        for (fs::path above = fs::path(job.output).parent_path(); !above.empty(); above = above.parent_path())
            if (by_output.count(above.string()) > 0)
                jobs.errors.push_back(job.origin + ": the output " + job.output + " is in a folder " +
                                      above.string() + " that another job writes as a file");
        const std::string target = fs::absolute(fs::path(folder) / job.output).lexically_normal();
        if (by_source.count(target) > 0)
            jobs.errors.push_back(job.origin + ": the output " + target + " is a source");
    }
}

/// More for a file that stores visibility cells, whatever the source: on one core, of 4 MiB.
constexpr double visibility_seconds = 100.0;

} // namespace

double BatchJob::seconds() const {
    const bool visibility = std::find(options.begin(), options.end(), "--visibility") != options.end();
    return kind->seconds + kind->seconds_each * double(bytes) + (visibility ? visibility_seconds : 0.0);
}

std::vector<std::string> BatchJob::files() const {
    if (!maps.empty()) return maps;
    if (kind == find_kind("brdf") && input::is_model(source)) return {};
    return input::probe_files(source);
}

BatchSetting parse_setting(const std::string& text) {
    const std::size_t equals = text.find('='), colon = text.rfind(':', equals);
    const std::size_t begin = colon == std::string::npos ? 0 : colon + 1, dot = text.find('.', begin);
    BatchSetting out;
    out.kind = dot == std::string::npos ? nullptr : find_kind(text.substr(begin, dot - begin));
    if (!out.kind || dot + 1 >= text.size() || text[dot + 1] == '-' || begin == 1)
        throw std::invalid_argument(
            "needs KIND.OPTION=VALUE, such as env.budget=64KiB, or KIND.OPTION; before it there "
            "may be a pattern of sources, as in 'angular/*:env.projection=angular'");
    if (begin > 0) out.pattern = text.substr(0, colon);
    out.option = "--" + text.substr(dot + 1);
    return out;
}

std::vector<std::string> BatchDefaults::options(const JobKind& kind, const std::string& source) const {
    const auto name = [](const std::string& option) { return option.substr(0, option.find('=')); };
    std::vector<std::string> out;
    for (const BatchSetting& setting : settings) {
        if (setting.kind != &kind) continue;
        if (!setting.pattern.empty() && fnmatch(setting.pattern.c_str(), source.c_str(), 0) != 0) continue;
        out.erase(std::remove_if(out.begin(), out.end(),
                                 [&](const std::string& other) { return name(other) == name(setting.option); }),
                  out.end());
        out.push_back(setting.option);
    }
    return out;
}

BatchJobs collect_jobs(const std::vector<std::string>& inputs, const BatchDefaults& defaults) {
    Collector collector(defaults);
    for (const std::string& input : inputs) collector.add_input(input);
    return collector.take();
}

std::string output_name_error(const std::string& name) {
    if (name.empty()) return "is empty";
    if (name.front() == '/') return "is an absolute path; outputs are below the output folder";
    if (name.find('\0') != std::string::npos) return "has a NUL in it";
    if (find_non_utf8(name) != std::string::npos) return "is not UTF-8";
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return "has a control character in it";
    for (const fs::path& part : fs::path(name)) {
        if (part == "..") return "has a part '..'; outputs are below the output folder";
        if (part.string().size() > 255) return "has a part of more than 255 bytes";
        if (part.string().compare(0, 6, ".acdf-") == 0) return "is named like a temporary file";
    }
    if (fs::path(name).extension() != ".acdf" || fs::path(name).stem().empty()) return "does not end in .acdf";
    return "";
}

void check_jobs(const std::string& folder, BatchJobs& jobs) {
    for (BatchJob& job : jobs.jobs)
        for (const std::string& what : {check_source(job), check_output(folder, job)})
            if (!what.empty()) jobs.errors.push_back(job.origin + ": " + what);
    if (jobs.errors.empty()) check_duplicates(folder, jobs);
}

} // namespace acdf::tools
