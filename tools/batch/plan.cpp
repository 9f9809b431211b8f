#include "tools/batch/plan.h"

#include "build/text/format_names.h"
#include "compress/parallel.h"
#include "input/probe/source.h"
#include "reader/check/check.h"
#include "tools/cli/file_input.h"
#include "tools/cli/messages.h"
#include "tools/cli/sequence.h"
#include "tools/cli/validation.h"
#include "tools/commands.h"

#include <acdf/curves/curves.h>
#include <acdf/visibility/visibility.h>

#include <tbb/enumerable_thread_specific.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <new>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

std::string value_of(const File& file, const char* key) {
    const Text text = file.metadata(key);
    return {text.data, text.size};
}

AcdfKind file_kind(const BatchJob& job) {
    if (!job.maps.empty()) return ACDF_KIND_INDEXED;
    return std::strcmp(job.kind->name, "env") == 0     ? ACDF_KIND_ENVIRONMENT
           : std::strcmp(job.kind->name, "local") == 0 ? ACDF_KIND_LOCAL
                                                       : ACDF_KIND_BRDF;
}

std::string first_fault(const std::vector<std::uint8_t>& bytes) {
    std::string fault;
    validate_all(bytes, [&](const Finding& finding) {
        if (code_of(finding.number) == ACDF_OK) return true;
        fault = "rule " + std::to_string(finding.number) + ": " + finding.detail;
        return false;
    });
    return fault;
}

/// Whether the file was made of the job's source, which is hashed only here: it costs most.
bool is_of_source(const File& file, const BatchJob& job) {
    const std::string hash = value_of(file, "source.sha256");
    const std::string name = input::probe_name(job.source);
    if (!job.maps.empty()) {
        std::vector<std::string> digests;
        for (const std::string& map : job.maps) digests.push_back(input::probe_sha256(map));
        return value_of(file, "source.name") == name && hash == sha256_of_maps(digests, job.source);
    }
    if (job.bytes == 0) return hash.empty() && value_of(file, "source.name") == job.source;
    return value_of(file, "source.name") == name && hash == input::probe_sha256(job.source);
}

/// The conversion of the job before, for one with the same options.
class Conversions {
public:
    explicit Conversions(const MakeConversion& make) : make_(make) {}

    Conversion& of(const BatchJob& job) {
        if (!last_ || job.kind != job_.kind || job.options != job_.options || job.base != job_.base ||
            !job.maps.empty() || !job_.maps.empty()) {
            std::shared_ptr<Conversion> next = make_(job);
            text_ = next->option_text(); // reads a scene
            last_ = std::move(next);
            job_ = job;
        }
        last_->source = job.source;
        return *last_;
    }

    /// Of the last conversion.
    const std::string& option_text() const { return text_; }

private:
    const MakeConversion& make_;
    BatchJob job_;
    std::shared_ptr<Conversion> last_;
    std::string text_;
};

/// Why the output with these bytes is to be made again; empty: it is not.
std::string why_due(const std::vector<std::uint8_t>& bytes, const BatchJob& job, const std::string& option_text,
                    PlannedJob& planned) {
    AcdfHeader header;
    if (bytes.size() < sizeof header) return "its output is cut short";
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.version_major != ACDF_VERSION_MAJOR || header.version_minor != ACDF_VERSION_MINOR)
        return "its output has format " + std::to_string(header.version_major) + "." +
               std::to_string(header.version_minor);
    if (std::string fault = first_fault(bytes); !fault.empty()) return "its output is not valid (" + fault + ")";
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file, with_curves()); !status.ok())
        return std::string("its output cannot be read (") + status.message + ")";
    if (file.kind() != file_kind(job)) return "its output is of kind " + build::kind_name(file.kind());
    VisibleLocalView view;
    if (file.kind() == ACDF_KIND_LOCAL)
        if (const Status status = VisibleLocalView::of(file, view); !status.ok())
            return std::string("its output is not valid (") + status.message + ")";
    if (const std::string had = value_of(file, "fit.options"); had != option_text)
        return "its options changed from " + had;
    if (!is_of_source(file, job)) return "its source changed";
    planned.bytes = bytes.size();
    planned.relative_variance = std::strtod(value_of(file, "accuracy.relative_variance").c_str(), nullptr);
    return "";
}

void look_at(PlannedJob& planned, const std::string& folder, const PlanOptions& options, Conversions& conversions) {
    const BatchJob& job = planned.job;
    const std::string path = (fs::path(folder) / job.output).string();
    const Conversion& conversion = conversions.of(job);
    planned.reason = "new";
    std::error_code unknown; // reported when it is written
    if (fs::exists(path, unknown)) {
        planned.reason = "forced";
        if (!options.force) {
            const std::vector<std::uint8_t> bytes = read_acdf_bytes(path);
            if (!bytes.empty() && !has_magic(bytes))
                throw Failure("the output " + path + " exists and is not an .acdf file; use --force to replace it");
            planned.reason = why_due(bytes, job, conversions.option_text(), planned);
        }
    }
    planned.due = !planned.reason.empty();
    if (!planned.due) planned.reason = "up to date";
    else if (options.memory) planned.memory = conversion.memory();
}

} // namespace

void check_options(BatchJobs& jobs, const MakeConversion& make) {
    std::map<std::vector<std::string>, std::string> seen; // what is wrong with them
    for (const BatchJob& job : jobs.jobs) {
        std::vector<std::string> key = job.options;
        key.insert(key.end(), {job.kind->name, job.base});
        key.insert(key.end(), job.maps.begin(), job.maps.end());
        const auto [found, is_new] = seen.emplace(std::move(key), "");
        if (is_new) try {
                make(job)->option_text(); // reads a scene
            } catch (const OptionError& error) {
                found->second = std::string("options of ") + job.kind->name + ": " + on_one_line(error.what());
            } catch (const std::runtime_error& error) {
                found->second = on_one_line(error.what());
            }
        if (!found->second.empty()) jobs.errors.push_back(job.origin + ": " + found->second);
    }
}

std::vector<PlannedJob> plan_jobs(const std::vector<BatchJob>& jobs, const std::string& folder,
                                  const PlanOptions& options, const MakeConversion& make,
                                  std::vector<std::string>& errors) {
    std::vector<PlannedJob> plan(jobs.size());
    std::vector<std::string> wrong(jobs.size());
    tbb::enumerable_thread_specific<Conversions> conversions([&] { return Conversions(make); });
    compress::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
        plan[i].job = jobs[i];
        try {
            look_at(plan[i], folder, options, conversions.local());
        } catch (const std::bad_alloc&) {
            throw; // of all jobs, not of this one
        } catch (const std::exception& error) {
            wrong[i] = jobs[i].origin + ": " + on_one_line(error.what());
        }
    });
    for (std::string& line : wrong)
        if (!line.empty()) errors.push_back(std::move(line));
    return plan;
}

} // namespace acdf::tools
