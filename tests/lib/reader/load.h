// Loading and validating bytes from memory that is exactly as long as they are, so that a sanitizer sees the
// first byte read beyond.
#pragma once

#include "tests/lib/reader/builder.h"

#include "reader/check/check.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <set>
#include <sstream>
#include <utility>

namespace acdf_test {

/// A heap copy of exact size, at `shift` bytes from an aligned address.
class Exact {
public:
    explicit Exact(const Bytes& bytes, std::size_t shift = 0)
        : block_(static_cast<std::uint8_t*>(std::malloc(bytes.size() + shift))), shift_(shift),
          size_(bytes.size()) {
        if (!bytes.empty()) std::memcpy(block_ + shift, bytes.data(), bytes.size());
    }
    ~Exact() { std::free(block_); }
    Exact(const Exact&) = delete;
    Exact& operator=(const Exact&) = delete;

    const std::uint8_t* data() const { return block_ + shift_; }
    std::size_t size() const { return size_; }

private:
    std::uint8_t* block_;
    std::size_t shift_, size_;
};

/// Loads and forgets.
inline acdf::Status load(const Bytes& bytes, const acdf::Limits& limits = {}) {
    const Exact exact(bytes);
    acdf::File file;
    return acdf::File::from_memory(exact.data(), exact.size(), file, acdf::with_curves(limits));
}

/// A file that stays open, and must be right.
class OpenedFile {
public:
    explicit OpenedFile(Bytes bytes, bool tables = true) : bytes_(std::move(bytes)) {
        acdf::LoadOptions options;
        options.tables = tables;
        const acdf::Status status = acdf::File::from_memory(bytes_.data(), bytes_.size(), file_, options);
        EXPECT_TRUE(status.ok()) << status.message;
    }
    const acdf::File& file() const { return file_; }
    const Bytes& bytes() const { return bytes_; }

private:
    Bytes bytes_;
    acdf::File file_;
};

struct Findings {
    std::multiset<int> rules;
    std::string text; ///< one line each
    std::uint64_t last_offset = 0;

    /// A FindingSink, of which these are the context.
    static bool take(const acdf::Finding& finding, void* findings) {
        auto& to = *static_cast<Findings*>(findings);
        to.rules.insert(finding.number);
        to.last_offset = finding.offset;
        std::ostringstream line;
        line << finding.number << " at " << finding.offset << ": " << finding.detail << '\n';
        to.text += line.str();
        return true;
    }
};

inline Findings findings(const Bytes& bytes, const acdf::Limits& limits = {}) {
    const Exact exact(bytes);
    Findings out;
    acdf::validate(exact.data(), exact.size(), Findings::take, &out, acdf::with_curves(limits));
    return out;
}

inline void expect_valid(const Bytes& file) {
    const Findings found = findings(file);
    EXPECT_TRUE(found.rules.empty()) << found.text;
}

inline std::string text(acdf::Text t) { return {t.data ? t.data : "", t.size}; }

} // namespace acdf_test
