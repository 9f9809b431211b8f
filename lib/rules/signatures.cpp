#include "rules/signatures.h"

#include <cstring>

namespace acdf {

namespace {

struct Signature {
    const char* bytes;
    std::size_t size;
    const char* text;
};

constexpr Signature signatures[] = {
    {"\x76\x2f\x31\x01", 4, "this is an OpenEXR image; `acdf env` makes an .acdf file of it"},
    {"#?RADIANCE", 10, "this is a Radiance HDR image; `acdf env` makes an .acdf file of it"},
    {"#?RGBE", 6, "this is a Radiance HDR image; `acdf env` makes an .acdf file of it"},
    {"\x89PNG", 4, "this is a PNG image, which holds no radiance"},
    {"\x93NUMPY", 6, "this is a NumPy array; `acdf table` makes an .acdf file of it"},
    {"II*\0", 4, "this is a TIFF image; `acdf env` makes an .acdf file of it"},
    {"MM\0*", 4, "this is a TIFF image; `acdf env` makes an .acdf file of it"},
    {"tensor_file", 11, "this is an RGL .bsdf file; `acdf brdf` makes an .acdf file of it"},
    {"version https://git-lfs", 23, "this is a Git LFS pointer, not the file itself; fetch that (git lfs pull)"},
    {"/annex/objects/", 15, "this is a git-annex pointer, not the file itself; fetch that (git annex get)"},
    {"<!", 2, "this is a web page, as servers send in place of a file; download the file itself"},
    {"<html", 5, "this is a web page, as servers send in place of a file; download the file itself"},
    {"<HTML", 5, "this is a web page, as servers send in place of a file; download the file itself"},
    {"<?xml", 5, "this is a web page, as servers send in place of a file; download the file itself"},
    {"\x1f\x8b", 2, "this is a gzip file; inflate it first"},
    {"\xab\x41\x43\x44\x46  \xbb\x0a\x1a\x0a", 11,
     "a transfer in text mode turned CR LF into LF; transfer it as binary"},
    {"\xab\x41\x43\x44\x46  \xbb\x0d\x0d\x0a", 11,
     "a transfer in text mode turned LF into CR LF; transfer it as binary"},
    {"\xab\x41\x43\x44\x46  \xbb\x0d\x0a\x1a\x0d\x0a", 13,
     "Git turned LF into CR LF; mark it as binary (in .gitattributes: -text)"},
    {"\x2b\x41\x43\x44\x46  \x3b", 8, "a transfer cut the highest bit of each byte; transfer it as binary"},
    {"\xab\x41\x43\x44\x46", 5, "it starts like an .acdf file, but its magic is damaged"},
};

} // namespace

const char* what_is_it(const std::uint8_t* bytes, std::size_t size) noexcept {
    for (const Signature& s : signatures)
        if (size >= s.size && std::memcmp(bytes, s.bytes, s.size) == 0) return s.text;
    std::uint32_t dims[3];
    constexpr std::size_t merl_size = 12 + std::size_t{3} * 8 * 90 * 90 * 180;
    if (size == merl_size) {
        std::memcpy(dims, bytes, sizeof dims);
        if (dims[0] == 90 && dims[1] == 90 && dims[2] == 180)
            return "this is a MERL BRDF; `acdf brdf` makes an .acdf file of it";
    }
    return "this is not an .acdf file";
}

} // namespace acdf
