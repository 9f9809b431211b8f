#include "input/brdf/brdf.h"

#include "input/brdf/merl.h"
#include "input/brdf/models.h"
#include "input/brdf/rgl.h"
#include "input/brdf/table.h"
#include "input/error.h"
#include "input/file_name.h"
#include "input/line_ends.h"
#include "input/other_kind.h"
#include "input/sha256.h"
#include "input/stand_in.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

namespace acdf::input {
namespace {

constexpr std::uintmax_t max_file = std::uintmax_t{1} << 31; // the largest of the RGL database has a fifth of it

std::vector<std::uint8_t> read_bytes(const std::string& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) throw input_error(path, "it is a folder; give a BRDF file");
    if (!std::filesystem::exists(path, error))
        throw input_error(path,
                          "there is no such file, and no model of this name (lambert, ggx, cook-torrance, blinn)");
    if (!std::filesystem::is_regular_file(path, error))
        throw input_error(path, "it is a pipe or a device; give a BRDF file");
    refuse_stand_in(path);
    refuse_converted_line_ends(path);
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) throw input_error(path, "it cannot be read: " + error.message());
    if (size > max_file) throw input_error(path, "it is larger than 2 GiB; give a BRDF file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw input_error(path, std::string("it cannot be opened: ") + std::strerror(errno));
    std::vector<std::uint8_t> bytes(size);
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        throw input_error(path, "it ended while it was read; copy it again");
    return bytes;
}

bool is_npy(const std::vector<std::uint8_t>& bytes) {
    return bytes.size() >= 6 && std::memcmp(bytes.data(), "\x93NUMPY", 6) == 0;
}

std::unique_ptr<Brdf> read_file(const std::string& path) {
    const std::filesystem::path file(path);
    const std::string extension = file.extension().string();
    const std::vector<std::uint8_t> bytes = read_bytes(path);
    if (bytes.empty()) throw input_error(path, "the file is empty; give a BRDF file");
    if (is_npy(bytes) || extension == ".npy") return read_brdf_npy(path, file_name(path));
    if (TensorFile::has_magic(bytes.data(), bytes.size()) || extension == ".bsdf" || extension == ".pbsdf")
        return parse_rgl(path, bytes.data(), bytes.size());
    if (bytes.size() == MerlLayout::bytes || extension == ".binary")
        return parse_merl(path, bytes.data(), bytes.size());
    const std::string kind = kind_of_no_brdf(path);
    throw input_error(path, kind.empty()
                                ? "it is not a BRDF file of a known kind; give a MERL .binary, an RGL .bsdf or an "
                                  ".npy file"
                                : kind);
}

} // namespace

std::unique_ptr<Brdf> open_brdf(const std::string& source) {
    if (is_model(source)) return model_brdf(source);
    try {
        std::unique_ptr<Brdf> brdf = read_file(source);
        brdf->name = file_name(source);
        brdf->sha256 = file_sha256(source);
        return brdf;
    } catch (const std::bad_alloc&) {
        throw input_error(source, "there is not enough memory for it");
    }
}

} // namespace acdf::input
