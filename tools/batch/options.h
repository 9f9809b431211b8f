// The options of `acdf batch`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace acdf::tools {

struct BatchArguments {
    std::vector<std::string> inputs, kinds, set;
    std::string output, memory, shard, emit;
    int threads = 0, jobs = 0;
    bool dry_run = false, force = false, merge = false, gallery = false, json = false, quiet = false;
};

void add_batch_options(CLI::App& command, BatchArguments& options);

} // namespace acdf::tools
