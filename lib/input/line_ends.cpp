#include "input/line_ends.h"

#include "input/error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace acdf::input {
namespace {

/// How the lines of a file end.
struct LineEnds {
    std::uint64_t lf = 0;          ///< without CR
    std::uint64_t crlf = 0;        ///< with it
    std::uint64_t binary_crlf = 0; ///< behind the first byte that is no text
};

bool is_text(unsigned char c) { return c >= 0x20 ? c < 0x7F : c == '\n' || c == '\r' || c == '\t'; }

/// Up to the first line end of the other kind than `expected`.
LineEnds line_ends_of(const std::string& path, bool expected_crlf) {
    LineEnds out;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return out;
    std::ifstream file(path, std::ios::binary);
    std::vector<char> block(1 << 16);
    bool binary = false, after_cr = false;
    while (file) {
        file.read(block.data(), static_cast<std::streamsize>(block.size()));
        for (std::streamsize i = 0; i < file.gcount(); ++i) {
            const auto c = static_cast<unsigned char>(block[static_cast<std::size_t>(i)]);
            binary = binary || !is_text(c);
            if (c == '\n') {
                ++(after_cr ? out.crlf : out.lf);
                out.binary_crlf += after_cr && binary;
                if (after_cr != expected_crlf) return out;
            }
            after_cr = c == '\r';
        }
    }
    return out;
}

} // namespace

void refuse_converted_line_ends(const std::string& path, unsigned least) {
    const LineEnds found = line_ends_of(path, true);
    const bool text_before = found.crlf > found.binary_crlf;
    if (found.lf == 0 && found.binary_crlf >= (text_before ? 1 : least))
        throw input_error(path,
                          "its line ends were converted (each LF is a CR LF now), by Git or a transfer in text "
                          "mode, but it is not text; fetch it again as binary (in .gitattributes: -text)");
}

std::string maybe_converted_line_ends(const std::string& path) {
    const LineEnds found = line_ends_of(path, false);
    return found.lf > 0 && found.crlf == 0
               ? ", or its line ends were converted (CR LF to LF, by Git or a transfer in text mode)"
               : "";
}

} // namespace acdf::input
