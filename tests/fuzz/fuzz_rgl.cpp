// Any bytes: reading them as an RGL tensor file gives a BRDF that is finite and not negative, or one line of text.
// The mutator starts from whole files, isotropic and not, RGB and spectral.
#include "input/brdf/rgl.h"
#include "input/error.h"
#include "tests/fuzz/brdf_values.h"
#include "tests/lib/input/brdf/brdf.h"

#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using namespace acdf::input;
using acdf_test::require;
using acdf_test::require_good;

acdf::test::Bytes seed_file(unsigned seed) {
    acdf::test::RglParts parts;
    parts.theta = {0.0f, 1.5f};
    parts.ndf_shape = parts.sigma_shape = parts.vndf_size = parts.colour_size = {2, 2};
    if (seed & 1u) parts.phi = {-3.1415927f, 0.0f, 3.1415927f};
    if (seed & 2u) parts.wavelengths = {400.0f, 450.0f, 500.0f, 550.0f, 600.0f, 650.0f};
    parts.jacobian = seed >> 2 & 1u;
    parts.fill(seed);
    return parts.bytes();
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    if (!TensorFile::has_magic(data, size) && seed % 8 != 0) {
        const acdf::test::Bytes file = seed_file(seed / 8);
        if (file.size() <= max_size) {
            std::memcpy(data, file.data(), file.size());
            size = file.size();
        }
    }
    return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        require_good(*parse_rgl("fuzz.bsdf", data, size));
    } catch (const Error& error) {
        const std::string text = error.what();
        require(text.rfind("fuzz.bsdf: ", 0) == 0 && text.find('\n') == std::string::npos);
    }
    return 0;
}
