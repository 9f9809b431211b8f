#include "input/sha256.h"

#include "input/error.h"
#include "input/file_name.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace acdf::input {
namespace {

class Sha256 {
public:
    Sha256() : ok_(digest_ && EVP_DigestInit_ex(digest_.get(), EVP_sha256(), nullptr) == 1) {}

    void add(const void* bytes, std::size_t size) {
        ok_ = ok_ && EVP_DigestUpdate(digest_.get(), bytes, size) == 1;
    }
    /// Empty where OpenSSL refused.
    std::string digits() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
        unsigned size = 0;
        std::string text;
        if (!ok_ || EVP_DigestFinal_ex(digest_.get(), bytes.data(), &size) != 1) return text;
        for (unsigned i = 0; i < size; ++i)
            for (const int nibble : {bytes[i] >> 4, bytes[i] & 15}) text += "0123456789abcdef"[nibble];
        return text;
    }

private:
    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> digest_{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
    bool ok_;
};

std::string digits_of(Sha256& digest, const std::string& path) {
    const std::string text = digest.digits();
    if (text.empty()) throw input_error(path, "its SHA-256 cannot be computed: OpenSSL refused");
    return text;
}

} // namespace

std::string file_sha256(const std::string& path) {
    require_regular_file(path, "an image file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw input_error(path, std::string("it cannot be opened: ") + std::strerror(errno));

    Sha256 digest;
    std::array<unsigned char, 65536> block;
    bool empty = true;
    for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), file.get())) > 0; empty = false)
        digest.add(block.data(), n);
    if (std::ferror(file.get())) throw input_error(path, std::string("it cannot be read: ") + std::strerror(errno));
    if (empty) throw input_error(path, "the file is empty; give an image file");
    return digits_of(digest, path);
}

std::string text_sha256(const std::string& text, const std::string& path) {
    Sha256 digest;
    digest.add(text.data(), text.size());
    return digits_of(digest, path);
}

} // namespace acdf::input
