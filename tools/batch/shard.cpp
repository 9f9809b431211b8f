#include "tools/batch/shard.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numeric>
#include <queue>
#include <stdexcept>

namespace acdf::tools {
namespace {

constexpr std::uint32_t most_shards = 1u << 20;

bool parse_count(std::string_view text, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::uint32_t slurm_number(const char* name, const char* fallback = nullptr) {
    const char* text = std::getenv(name);
    if (!text) text = fallback;
    std::uint32_t value = 0;
    if (!text || !parse_count(text, value))
        throw std::invalid_argument(std::string("slurm: the environment has no ") + name +
                                    "; run in an array job (sbatch --array=1-N)");
    return value;
}

Shard slurm_shard() {
    const std::uint32_t id = slurm_number("SLURM_ARRAY_TASK_ID"), first = slurm_number("SLURM_ARRAY_TASK_MIN");
    const std::uint32_t last = slurm_number("SLURM_ARRAY_TASK_MAX"), count = slurm_number("SLURM_ARRAY_TASK_COUNT");
    const std::uint32_t step = slurm_number("SLURM_ARRAY_TASK_STEP", "1");
    if (step == 0 || count == 0 || first > last || id < first || id > last || (id - first) % step != 0 ||
        (last - first) / step + 1 != count)
        throw std::invalid_argument("slurm: the indices of the array have gaps; use --array=1-N, or --shard I/N");
    return {(id - first) / step + 1, count};
}

/// FNV-1a (Fowler, Noll, Vo).
std::uint64_t hash(const std::string& text, std::uint64_t state = 0xcbf29ce484222325u) {
    for (const char c : text) state = (state ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return (state ^ 0xff) * 0x100000001b3u;
}

} // namespace

Shard parse_shard(const std::string& text) {
    if (text == "slurm") return slurm_shard();
    Shard shard;
    const std::size_t slash = text.find('/');
    const std::string_view view = text;
    if (slash == std::string::npos || !parse_count(view.substr(0, slash), shard.index) ||
        !parse_count(view.substr(slash + 1), shard.count) || shard.index < 1 || shard.index > shard.count ||
        shard.count > most_shards)
        throw std::invalid_argument("needs a part such as 3/8, from 1/8 to 8/8, or slurm");
    return shard;
}

std::vector<BatchJob> jobs_of_shard(const std::vector<BatchJob>& jobs, const Shard& shard) {
    if (shard.count == 1) return jobs;
    std::vector<std::size_t> order(jobs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const double x = jobs[a].seconds(), y = jobs[b].seconds();
        return x != y ? x > y : jobs[a].output < jobs[b].output;
    });
    using Load = std::pair<double, std::uint32_t>; // least load first, then least index
    std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
    for (std::uint32_t i = 1; i <= shard.count; ++i) loads.push({0.0, i});
    std::vector<bool> mine(jobs.size());
    for (const std::size_t job : order) {
        const auto [load, index] = loads.top();
        loads.pop();
        mine[job] = index == shard.index;
        loads.push({load + jobs[job].seconds(), index});
    }
    std::vector<BatchJob> out;
    for (std::size_t i = 0; i < jobs.size(); ++i)
        if (mine[i]) out.push_back(jobs[i]);
    return out;
}

std::string batch_id(const std::vector<BatchJob>& jobs) {
    std::uint64_t sum = jobs.size();
    for (const BatchJob& job : jobs) {
        std::uint64_t state = hash(job.output, hash(job.kind->name));
        state = hash(std::filesystem::path(job.source).filename().string(), state);
        state = hash(std::to_string(job.bytes), state);
        for (const std::string& option : job.options) state = hash(option, state);
        sum += state;
    }
    char text[24];
    std::snprintf(text, sizeof text, "%016" PRIx64, sum);
    return text;
}

} // namespace acdf::tools
