#include "input/file_name.h"
#include "input/image.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace acdf::input {

std::string file_sha256(const std::string& path) {
    require_regular_file(path, "an image file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw input_error(path, std::string("it cannot be opened: ") + std::strerror(errno));

    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> digest(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
    bool ok = digest && EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) == 1;
    std::array<unsigned char, 65536> block;
    bool empty = true;
    for (std::size_t n; ok && (n = std::fread(block.data(), 1, block.size(), file.get())) > 0; empty = false)
        ok = EVP_DigestUpdate(digest.get(), block.data(), n) == 1;
    if (std::ferror(file.get())) throw input_error(path, std::string("it cannot be read: ") + std::strerror(errno));
    if (empty) throw input_error(path, "the file is empty; give an image file");

    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
    unsigned size = 0;
    ok = ok && EVP_DigestFinal_ex(digest.get(), bytes.data(), &size) == 1;
    if (!ok) throw input_error(path, "its SHA-256 cannot be computed: OpenSSL refused");
    std::string text;
    for (unsigned i = 0; i < size; ++i)
        for (const int nibble : {bytes[i] >> 4, bytes[i] & 15}) text += "0123456789abcdef"[nibble];
    return text;
}

} // namespace acdf::input
