#include "tools/cli/nearest.h"

#include "input/file_name.h"

#include <algorithm>
#include <cstddef>

namespace acdf::tools {
namespace {

/// Letters that differ, with swapped neighbours as one (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = last;
        last = row;
    }
    return last[b.size()];
}

constexpr std::size_t kLongestWord = 64;

} // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& names) {
    if (word.empty() || word.size() > kLongestWord) return "";
    const std::string lower = input::lower(word);
    std::vector<std::string> begun;
    for (const std::string& name : names)
        if (lower.size() > 2 && name.compare(0, lower.size(), lower) == 0) begun.push_back(name);
    if (begun.size() == 1) return begun[0];
    std::string nearest;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t d = edit_distance(lower, name);
        if (d >= least || d >= name.size()) continue;
        least = d;
        nearest = name;
    }
    return nearest;
}

} // namespace acdf::tools
