#include "build/text/format_names.h"

#include <cctype>

namespace acdf::build {
namespace {

struct Name {
    std::uint32_t value;
    const char* name;
};

// A reader accepts a higher minor version, which may bring values that this program has no name for.
template <std::size_t N>
std::string lookup(const Name (&names)[N], std::uint32_t value) {
    for (const Name& name : names)
        if (name.value == value) return name.name;
    return std::to_string(value);
}

constexpr Name kinds[] = {{ACDF_KIND_ENVIRONMENT, "environment"},
                          {ACDF_KIND_LOCAL, "local"},
                          {ACDF_KIND_BRDF, "brdf"},
                          {ACDF_KIND_TABLE, "table"},
                          {ACDF_KIND_INDEXED, "indexed"}};
constexpr Name parameterizations[] = {{ACDF_PARAM_LATLONG, "latlong"},
                                      {ACDF_PARAM_HALF_ANGLE, "half-angle"},
                                      {ACDF_PARAM_TABLE, "table"},
                                      {ACDF_PARAM_OCTAHEDRAL, "octahedral"}};
constexpr Name fits[] = {
    {ACDF_FIT_UNIFORM, "uniform"}, {ACDF_FIT_CDF, "cdf"}, {ACDF_FIT_PDF, "pdf"}, {ACDF_FIT_VARIANCE, "variance"}};
constexpr Name filters[] = {{ACDF_FILTER_NEAREST, "nearest"}, {ACDF_FILTER_BILINEAR, "bilinear"}};
constexpr Name codecs[] = {{ACDF_CODEC_NONE, "none"}, {ACDF_CODEC_ZLIB, "zlib"}, {ACDF_CODEC_PLANES, "planes"}};
constexpr Name roles[] = {{ACDF_AXIS_SAMPLED, "sampled"}, {ACDF_AXIS_INDEXED, "indexed"}};
constexpr Name measures[] = {
    {ACDF_MEASURE_LINEAR, "linear"}, {ACDF_MEASURE_COSINE, "cosine"}, {ACDF_MEASURE_HALF, "half"}};

} // namespace

std::string kind_name(std::uint32_t kind) { return lookup(kinds, kind); }
std::string parameterization_name(std::uint32_t value) { return lookup(parameterizations, value); }
std::string fit_name(std::uint32_t fit) { return lookup(fits, fit); }
std::string filter_name(std::uint32_t filter) { return lookup(filters, filter); }
std::string codec_name(std::uint32_t codec) { return lookup(codecs, codec); }
std::string role_name(std::uint32_t role) { return lookup(roles, role); }
std::string measure_name(std::uint32_t measure) { return lookup(measures, measure); }

std::string chunk_name(std::uint32_t type) {
    std::string name;
    for (int i = 0; i < 4; ++i) {
        const auto c = static_cast<unsigned char>(type >> (8 * i));
        name += std::isprint(c) ? static_cast<char>(c) : '?';
    }
    return name;
}

} // namespace acdf::build
