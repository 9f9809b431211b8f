// acdf batch on a folder of its own, and what it leaves there.
#pragma once

#include "tests/tools/batch/files.h"
#include "tests/tools/run.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>

namespace acdf::test {

/// What files hold, by name.
using Files = std::map<std::string, std::string>;

/// All files in a folder and below, by name.
inline Files files_in(const std::string& folder) {
    Files files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).string()] = read_text(entry.path());
    return files;
}

class BatchCommand : public testing::Test {
protected:
    Folder folder;
    const std::string probes = folder / "probes", out = folder / "out", manifest = folder / "library.jsonl";

    Result batch(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "batch");
        arguments.insert(arguments.end(), {"-o", out});
        return run_acdf(arguments);
    }

    nlohmann::json report(std::vector<std::string> arguments, int code = 0) {
        arguments.push_back("--json");
        const Result result = batch(arguments);
        EXPECT_EQ(result.code, code) << result.err;
        messages = result.err;
        return nlohmann::json::parse(result.out, nullptr, false);
    }
    std::string messages;

    /// A manifest of these lines is refused, with `what` on a line of its own, and nothing is written.
    void expect_refused(const std::string& lines, const std::string& what) {
        write_text(manifest, lines);
        const Result result = batch({manifest});
        EXPECT_EQ(result.code, 1) << what;
        EXPECT_NE(result.err.find(what), std::string::npos) << what << " is not in: " << result.err;
        EXPECT_NE(result.err.find("nothing was started"), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
};

} // namespace acdf::test
