// The rules of format/SPEC.md in words: for `acdf validate` and tests. The reader knows their numbers alone.
#pragma once

#include <cstddef>

namespace acdf {

enum class Severity { warning, error };

struct Rule {
    int number;           ///< 10xx I/O, 20xx header, 30xx chunk table, 40xx payload, 50xx DESC and META,
                          ///< 60xx curves and bins, 70xx environment, 80xx BRDF (reserved); never reused
    Severity severity;    ///< a file with a warning is read
    const char* id;       ///< short stable name, for people and for the names of test files
    const char* sentence; ///< what must hold, word for word as in SPEC.md
};

extern const Rule rules[];
extern const std::size_t rule_count;

/// The rule of that number, null where there is none.
const Rule* find_rule(int number) noexcept;

} // namespace acdf
