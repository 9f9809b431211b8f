#include "tools/batch/report.h"

#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace acdf::tools {
namespace {

using Json = nlohmann::ordered_json;
using Status = JobResult::Status;

const char* to_string(Status status) {
    return status == Status::done ? "done" : status == Status::up_to_date ? "up to date" : "failed";
}

Status parse_status(const std::string& text) {
    for (const Status status : {Status::done, Status::up_to_date, Status::failed})
        if (text == to_string(status)) return status;
    throw std::invalid_argument("'" + text + "' is not a status of a job");
}

Json to_json(const JobResult& job) {
    const bool made = job.status != Status::failed, worked = job.status != Status::up_to_date;
    Json json{{"input", job.input}, {"output", job.output}, {"kind", job.kind}, {"status", to_string(job.status)}};
    json["bytes"] = made ? Json(job.bytes) : Json();
    json["relative_variance"] = made ? Json(job.relative_variance) : Json(); // JSON has no infinity: null too
    json["noise_percent"] = made ? noise_json(job.relative_variance) : Json();
    json["seconds"] = worked ? Json(job.seconds) : Json();
    json["error"] = made ? Json() : Json(job.error);
    json["notes"] = job.notes;
    return json;
}

template <typename Number>
Number number_or_zero(const Json& value) {
    return value.is_null() ? Number{0} : value.get<Number>();
}

JobResult parse_job(const Json& json) {
    JobResult job;
    job.input = json.at("input").get<std::string>();
    job.output = json.at("output").get<std::string>();
    job.kind = json.at("kind").get<std::string>();
    job.status = parse_status(json.at("status").get<std::string>());
    job.bytes = number_or_zero<std::uint64_t>(json.at("bytes"));
    job.relative_variance = number_or_zero<double>(json.at("relative_variance"));
    job.seconds = number_or_zero<double>(json.at("seconds"));
    if (!json.at("error").is_null()) job.error = json.at("error").get<std::string>();
    job.notes = json.at("notes").get<std::vector<std::string>>();
    return job;
}

/// A row of the table.
struct Sum {
    std::size_t jobs = 0, by_status[3] = {};
    std::uint64_t bytes = 0;
    double log_variance = 0.0, seconds = 0.0;
    std::size_t measured = 0;

    void add(const JobResult& job) {
        ++jobs;
        ++by_status[static_cast<std::size_t>(job.status)];
        bytes += job.bytes;
        seconds += job.seconds;
        if (job.status == Status::failed || !(job.relative_variance > 0.0)) return;
        log_variance += std::log(job.relative_variance);
        ++measured;
    }

    std::string row(const std::string& name) const {
        char variance[16] = "-", text[192];
        std::string noise = "-";
        if (measured > 0) {
            const double mean = std::exp(log_variance / double(measured));
            std::snprintf(variance, sizeof variance, "%.3g", mean);
            noise = noise_texts(mean);
        }
        std::snprintf(text, sizeof text, "%-6s %7zu %7zu %11zu %7zu %12s %18s %22s %9.1f\n", name.c_str(), jobs,
                      by_status[0], by_status[1], by_status[2], to_readable_size(bytes).c_str(), variance,
                      noise.c_str(), seconds);
        return text;
    }
};

constexpr std::size_t most_rows = 60, most_named = 5;

/// What errors advise, as an option of a batch: some sources of a folder need it, and others do not.
struct Advised {
    const char *option, *value, *folder;
};
constexpr Advised advised_options[] = {
    {"projection", "angular", "angular"}, {"bad-pixels", "clamp", "suns"}, {"on-black", "uniform", "black"}};

/// "a, b, c, d, e and 3 more"
std::string first_few(const std::vector<std::string>& names) {
    std::string line;
    for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i) line += (i > 0 ? ", " : "") + names[i];
    if (names.size() > most_named) line += " and " + std::to_string(names.size() - most_named) + " more";
    return line;
}

/// Each number as one #.
std::string without_numbers(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool digit = c >= '0' && c <= '9';
        if (!digit || out.empty() || out.back() != '#') out += digit ? '#' : c;
    }
    return out;
}

std::string file_rows(const std::vector<JobResult>& jobs) {
    std::size_t width = 4;
    for (const JobResult& job : jobs) width = std::max(width, job.output.size());
    const auto padded = [&](std::string name) { return name.append(width - std::min(width, name.size()), ' '); };
    std::string text = padded("file") + "       bytes  relative variance   seconds\n";
    for (const JobResult& job : jobs) {
        char numbers[96];
        if (job.status == Status::failed) std::snprintf(numbers, sizeof numbers, " %11s", "failed");
        else
            std::snprintf(numbers, sizeof numbers, " %11s %18.3g %9.1f", to_readable_size(job.bytes).c_str(),
                          job.relative_variance, job.seconds);
        text += padded(job.output) + numbers + (job.status == Status::up_to_date ? "  up to date\n" : "\n");
    }
    return text + "\n";
}

} // namespace

std::string told_in_batch(const JobResult& job) {
    for (const Advised& advised : advised_options) {
        if (job.error.find(std::string("--") + advised.option) == std::string::npos) continue;
        const std::string setting = std::string(advised.option) + "=" + advised.value,
                          source = std::string(advised.folder) + "/a.hdr",
                          kind = job.kind == "env" ? "" : "\"kind\": \"" + job.kind + "\", ";
        return job.error + " (in a batch: --set '" + advised.folder + "/*:" + job.kind + "." + setting +
               "' for a pattern of sources, or in a manifest {\"source\": \"" + source + "\", " + kind +
               "\"options\": {\"" + advised.option + "\": \"" + advised.value + "\"}})";
    }
    return job.error;
}

std::vector<std::string> grouped(const std::vector<std::string>& errors) {
    std::vector<std::string> whats;
    std::map<std::string, std::vector<std::string>> names;
    for (const std::string& error : errors) {
        const std::size_t colon = error.find(": ");
        const std::string what = colon == std::string::npos ? error : error.substr(colon + 2);
        std::vector<std::string>& known = names[what];
        if (known.empty()) whats.push_back(what);
        known.push_back(colon == std::string::npos ? "" : error.substr(0, colon));
    }
    std::vector<std::string> lines;
    for (const std::string& what : whats) {
        const std::string line = first_few(names[what]);
        lines.push_back(line.empty() ? what : line + ": " + what);
    }
    return lines;
}

std::vector<std::string> remarks(const std::vector<JobResult>& jobs) {
    struct Kind {
        std::string first; // as it was said first
        std::vector<std::string> sources;
        bool alike = true; // in their numbers, too
    };
    std::vector<std::string> order;
    std::map<std::string, Kind> kinds;
    for (const JobResult& job : jobs)
        for (const std::string& note : job.notes) {
            const std::string key = without_numbers(note);
            const auto [found, is_new] = kinds.try_emplace(key);
            Kind& kind = found->second;
            if (is_new) {
                order.push_back(key);
                kind.first = note;
            }
            kind.alike &= note == kind.first;
            if (std::find(kind.sources.begin(), kind.sources.end(), job.input) == kind.sources.end())
                kind.sources.push_back(job.input);
        }
    std::vector<std::string> lines;
    for (const std::string& key : order) {
        const Kind& kind = kinds[key];
        lines.push_back(on_one_line(first_few(kind.sources) + ": " + kind.first +
                                    (kind.alike ? "" : " (numbers of " + kind.sources.front() + ")")));
    }
    return lines;
}

std::size_t BatchReport::count(Status status) const {
    return static_cast<std::size_t>(
        std::count_if(jobs.begin(), jobs.end(), [&](const JobResult& job) { return job.status == status; }));
}

std::string to_json(const BatchReport& report) {
    Json jobs = Json::array();
    for (const JobResult& job : report.jobs) jobs.push_back(to_json(job));
    return json_text({{"batch", report.batch},
                      {"shard", {{"index", report.shard.index}, {"count", report.shard.count}}},
                      {"done", report.count(Status::done)},
                      {"up_to_date", report.count(Status::up_to_date)},
                      {"failed", report.count(Status::failed)},
                      {"jobs", std::move(jobs)}});
}

BatchReport parse_report(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        BatchReport report;
        report.batch = json.at("batch").get<std::string>();
        report.shard = {json.at("shard").at("index").get<std::uint32_t>(),
                        json.at("shard").at("count").get<std::uint32_t>()};
        if (report.shard.index < 1 || report.shard.index > report.shard.count)
            throw std::invalid_argument("there is no such shard");
        for (const Json& job : json.at("jobs")) report.jobs.push_back(parse_job(job));
        return report;
    } catch (const Json::parse_error& error) {
        throw std::invalid_argument("is not a report of `acdf batch --json`: it is not JSON from byte " +
                                    std::to_string(error.byte) + " on");
    } catch (const Json::exception&) {
        throw std::invalid_argument("is not a report of `acdf batch --json`: a key is missing, or of another type");
    }
}

MergedReport merge_reports(const std::vector<BatchReport>& reports) {
    if (reports.empty()) throw std::invalid_argument("there are no reports");
    MergedReport out;
    out.report.batch = reports[0].batch;
    std::map<std::uint32_t, const BatchReport*> by_shard;
    for (const BatchReport& report : reports) {
        if (report.batch != reports[0].batch || report.shard.count != reports[0].shard.count)
            throw std::invalid_argument(
                "the reports are of different batches: of other sources, options or shards");
        by_shard[report.shard.index] = &report;
    }
    const std::uint32_t count = reports[0].shard.count;
    for (std::uint32_t i = 1; i <= count && out.problems.size() < 20; ++i)
        if (by_shard.count(i) == 0)
            out.problems.push_back("shard " + std::to_string(i) + "/" + std::to_string(count) + " has no report");
    for (const auto& [index, report] : by_shard)
        out.report.jobs.insert(out.report.jobs.end(), report->jobs.begin(), report->jobs.end());
    std::sort(out.report.jobs.begin(), out.report.jobs.end(),
              [](const JobResult& a, const JobResult& b) { return a.output < b.output; });
    return out;
}

std::string summary_table(const BatchReport& report) {
    std::map<std::string, Sum> kinds;
    Sum all;
    for (const JobResult& job : report.jobs) {
        kinds[job.kind].add(job);
        all.add(job);
    }
    std::string text = report.jobs.size() <= most_rows ? file_rows(report.jobs) : "";
    text += "kind      jobs    done  up to date  failed        bytes  relative variance   "
            "noise at 16, 64, 256   seconds\n";
    for (const auto& [name, sum] : kinds) text += sum.row(name);
    if (kinds.size() > 1) text += all.row("all");
    const std::vector<std::string> lines = remarks(report.jobs);
    if (!lines.empty()) text += "\n";
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

} // namespace acdf::tools
