// Any bytes: reading them as a MERL file gives a BRDF that is finite and not negative, or one line of text. A file
// has a fixed size, so some inputs are repeated behind a good header until they have it.
#include "input/brdf/merl.h"
#include "input/error.h"
#include "tests/fuzz/brdf_values.h"

#include <algorithm>
#include <cstring>

namespace {

using namespace acdf::input;
using acdf_test::require;
using acdf_test::require_good;

void parse(const std::uint8_t* data, std::size_t size) {
    try {
        require_good(*parse_merl("fuzz.binary", data, size));
    } catch (const Error& error) {
        const std::string text = error.what();
        require(text.rfind("fuzz.binary: ", 0) == 0 && text.find('\n') == std::string::npos);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    parse(data, size);
    if (size < 8 || size % 256 != 0) return 0;
    std::vector<std::uint8_t> whole(MerlLayout::bytes);
    const std::int32_t header[3] = {90, 90, 180};
    std::memcpy(whole.data(), header, sizeof header);
    for (std::size_t at = sizeof header; at < whole.size(); at += size)
        std::memcpy(&whole[at], data, std::min(size, whole.size() - at));
    parse(whole.data(), whole.size());
    return 0;
}
