#include "check/top.h"

namespace acdf {

bool check_top(Bits& bits, std::uint32_t count, Report& report, const Parts& parts) noexcept {
    struct Open {
        std::uint32_t node;
        bool top;
    } open[most_open_halvings];
    const std::uint64_t begin = bits.place();
    std::uint32_t found = 0, waiting = 0;
    if (parts.halving_count > 0) open[waiting++] = {0, true};
    while (waiting > 0) { // in preorder
        const Open at = open[--waiting];
        const std::uint64_t place = bits.place();
        const bool own = bits.take(1);
        found += own;
        if (own && !at.top) {
            report.add(6037, place, "halving %u has codes of rows, the one above it has none", at.node);
            return false;
        }
        const std::uint32_t link = parts.halvings[at.node].link;
        if (!(link >> 4 & 1u)) open[waiting++] = {at.node + (link >> 5), own};
        if (!(link >> 3 & 1u)) open[waiting++] = {at.node + 1, own};
    }
    if (found != count) {
        report.add(6037, begin, "%u halvings have codes of rows, not %u", found, count);
        return false;
    }
    while (bits.has(1))
        if (bits.take(1)) {
            report.add(6038, begin, "padding behind the splits is not zero");
            return false;
        }
    return true;
}

} // namespace acdf
