// Any bytes: reading them as an .npy file gives a whole array of good numbers or one line of text. The mutator
// keeps magic and header length right most of the time, so that the parser behind them is reached.
#include "input/npy.h"
#include "tests/fuzz/require.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using acdf_test::require;

constexpr std::uint8_t start[10] = {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, 0, 0};
constexpr char dict[] = "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }\n";

void require_good(const acdf::input::NpyArray& array) {
    std::uint64_t count = 1;
    require(!array.shape.empty() && array.shape.size() <= 6);
    for (const std::uint32_t length : array.shape) count *= length;
    require(count == array.values.size() && array.bad.count() <= count);
    require(std::isfinite(array.scale) && array.scale > 0.0);
    for (const float value : array.values) require(value >= 0.0f && std::isfinite(value));
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    if (size < sizeof start && max_size > 128) { // begin with a whole file
        std::memcpy(data, start, sizeof start);
        std::memcpy(data + sizeof start, dict, sizeof dict - 1);
        size = sizeof start + sizeof dict - 1 + 24;
        std::memset(data + size - 24, 0x3F, 24);
    }
    size = LLVMFuzzerMutate(data, size, max_size);
    if (seed % 8 == 0 || size < sizeof start) return size;
    std::memcpy(data, start, 8);
    const std::uint8_t* const end = std::find(data + sizeof start, data + size, '\n');
    const auto length = static_cast<std::size_t>(end - data) + (end != data + size) - sizeof start;
    data[8] = static_cast<std::uint8_t>(length);
    data[9] = static_cast<std::uint8_t>(length >> 8);
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace acdf::input;
    std::vector<std::uint8_t> bytes(data, data + size);
    bytes.push_back(0); // fmemopen refuses to open nothing
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(fmemopen(bytes.data(), bytes.size(), "rb"),
                                                               &std::fclose);
    if (!file) return 0;
    NpyOptions options;
    options.bad_values = size % 2 ? BadValuePolicy::zero : BadValuePolicy::refuse;
    try {
        require_good(read_npy(file.get(), size, "fuzz.npy", options));
    } catch (const Error& error) {
        const std::string text = error.what();
        require(text.rfind("fuzz.npy: ", 0) == 0 && text.find('\n') == std::string::npos);
    }
    return 0;
}
