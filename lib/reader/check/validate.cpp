#include "check/checker.h"
#include "memory.h"

#include <cstdlib>
#include <cstring>

namespace acdf {

Verdict validate(const void* bytes, std::size_t size, FindingSink sink, void* context,
                 const LoadOptions& options) noexcept {
    const u8* data = static_cast<const u8*>(bytes);
    void* copy = nullptr;
    Parts parts;
    Verdict verdict;
    if (size > options.limits.max_file_bytes) {
        Report report(sink, context);
        report.add(1004, 0, "the file has %llu bytes, the limit is %llu", static_cast<ull>(size),
                   static_cast<ull>(options.limits.max_file_bytes));
        return report.verdict();
    }
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(AcdfHeader) != 0) {
        copy = std::malloc(size ? size : 1);
        if (!copy) {
            Report report(sink, context);
            report.add(1003, 0, "no memory for a copy of %llu bytes", static_cast<ull>(size));
            return report.verdict();
        }
        data = static_cast<const u8*>(std::memcpy(copy, bytes, size));
    }
    verdict = check(data, size, options, sink, context, parts);
    give_block(options.allocator, parts.inflated);
    std::free(copy);
    return verdict;
}

} // namespace acdf
