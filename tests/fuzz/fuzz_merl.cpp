// Any bytes: reading them as a MERL file gives a BRDF that is finite and not negative, or one line of text. A file
// has a fixed size, so some inputs are repeated behind a good header until they have it.
#include "input/image.h"
#include "input/merl.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace {

using namespace acdf::input;

void require(bool condition) {
    if (!condition) std::abort();
}

void require_good(const Brdf& brdf) {
    const double directions[][3] = {
        {0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}, {-0.8, 0.0, 0.6}, {0.0, 1.0, 1e-9}, {0.0, 0.6, -0.8}};
    for (const auto& wo : directions)
        for (const auto& wi : directions) {
            double rgb[3];
            brdf.evaluate(wo, wi, rgb);
            for (const double v : rgb) require(std::isfinite(v) && v >= 0.0);
        }
}

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
