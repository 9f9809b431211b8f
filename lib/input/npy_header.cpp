#include "input/npy.h"

#include "input/error.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace acdf::input {
namespace {

constexpr std::size_t max_header = 65535;        // what version 1 can say; the header of a plain array has 118
constexpr std::uint64_t max_length = 0x7FFFFFFF; // of an axis in an .acdf file
constexpr std::uint64_t max_count = UINT64_C(1) << 34; // 64 GiB as floats; products of lengths cannot overflow
constexpr std::size_t max_dimensions = 6;

/// Reads the literal of a Python dict as numpy writes it: {'descr': '<f4', 'fortran_order': False, 'shape': (3,), }
class Literal {
public:
    Literal(const std::string& name, const char* begin, const char* end) : name_(name), at_(begin), end_(end) {}

    NpyHeader parse() {
        NpyHeader header;
        bool descr = false, order = false, shape = false;
        expect('{');
        while (!accept('}')) {
            const std::string key = string();
            expect(':');
            if (key == "descr" && !descr) descr = true, header.item_size = item_size();
            else if (key == "fortran_order" && !order) order = true, header.fortran_order = boolean();
            else if (key == "shape" && !shape) shape = true, header.shape = tuple();
            else fail("'" + key + "' is unknown or comes twice");
            if (!accept(',')) {
                expect('}');
                break;
            }
        }
        skip_space();
        if (at_ != end_) fail("something follows its '}'");
        if (!descr || !order || !shape) fail("'descr', 'fortran_order' or 'shape' is missing");
        return header;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw input_error(name_, "its .npy header is damaged: " + what + "; save it again with numpy.save");
    }

    void skip_space() {
        while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
    }
    bool accept(char c) {
        skip_space();
        if (at_ == end_ || *at_ != c) return false;
        ++at_;
        return true;
    }
    void expect(char c) {
        if (!accept(c))
            fail(std::string("'") + c + "' is expected at byte " + std::to_string(end_ - at_) + " from its end");
    }
    bool accept_word(const char* word) {
        skip_space();
        const std::size_t length = std::strlen(word);
        if (static_cast<std::size_t>(end_ - at_) < length || std::memcmp(at_, word, length) != 0) return false;
        at_ += length;
        return true;
    }

    std::string string() {
        skip_space();
        if (at_ == end_ || (*at_ != '\'' && *at_ != '"')) fail("a quoted string is expected");
        const char quote = *at_++;
        const char* const close = std::find(at_, end_, quote);
        if (close == end_ || close - at_ > 64) fail("a string does not end");
        std::string text(at_, close);
        if (text.find('\\') != std::string::npos) fail("a string has escapes");
        for (const char c : text)
            if (c < 0x20 || c > 0x7E) fail("a string is not printable ASCII");
        at_ = close + 1;
        return text;
    }

    bool boolean() {
        if (accept_word("True")) return true;
        if (!accept_word("False")) fail("True or False is expected");
        return false;
    }

    std::uint64_t integer() {
        skip_space();
        std::uint64_t value = 0;
        const char* const begin = at_;
        for (; at_ != end_ && *at_ >= '0' && *at_ <= '9'; ++at_) {
            if (at_ - begin >= 18) fail("a length of more than 18 digits");
            value = 10 * value + static_cast<std::uint64_t>(*at_ - '0');
        }
        if (at_ == begin || (*begin == '0' && at_ - begin > 1)) fail("a length is expected");
        return value;
    }

    std::vector<std::uint32_t> tuple() {
        std::vector<std::uint64_t> lengths;
        expect('(');
        bool comma = true; // (3) is no tuple, (3,) is
        while (!accept(')')) {
            if (!comma) fail("',' is expected in 'shape'");
            lengths.push_back(integer());
            if (lengths.size() > 64) fail("'shape' has more than 64 lengths");
            comma = accept(',');
        }
        if (lengths.size() == 1 && !comma) fail("'shape' is not a tuple");
        return checked(lengths);
    }

    std::vector<std::uint32_t> checked(const std::vector<std::uint64_t>& lengths) const {
        if (lengths.empty())
            throw input_error(name_, "it holds a single number, no table; save an array with at least one axis");
        if (lengths.size() > max_dimensions)
            throw input_error(name_, "it has " + std::to_string(lengths.size()) +
                                         " axes; tables of 1 to 6 axes are read: join or sum over some");
        std::uint64_t count = 1;
        for (const std::uint64_t length : lengths) {
            if (length == 0) throw input_error(name_, "it is empty: an axis of its shape has length 0");
            if (length > max_length || count > max_count / length)
                throw input_error(name_, "its shape claims more than 2^34 numbers; reduce its resolution");
            count *= length;
        }
        return {lengths.begin(), lengths.end()};
    }

    std::uint32_t item_size() {
        skip_space();
        if (at_ != end_ && *at_ == '[')
            throw input_error(name_, "it holds records (a structured dtype); save one field, as in a['field']");
        const std::string descr = string();
        const std::string kind = descr.substr(
            descr.find_first_not_of("<>|=") == std::string::npos ? descr.size() : descr.find_first_not_of("<>|="));
        const std::string order = descr.substr(0, descr.size() - kind.size());
        if (kind == "f4" || kind == "f8") {
            if (order == ">")
                throw input_error(name_,
                                  "its numbers are big-endian ('" + descr + "'); save a.astype('<" + kind + "')");
            if (order == "<" || order == "=" || order == "|") return kind == "f4" ? 4 : 8; // '=': of this machine
        }
        throw input_error(name_, "its numbers are of type '" + descr +
                                     "'; float32 and float64 are read: save a.astype('<f4')");
    }

    const std::string& name_;
    const char* at_;
    const char* const end_;
};

std::uint32_t little_endian(const std::uint8_t* data, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint32_t{data[i]} << (8 * i);
    return value;
}

} // namespace

std::uint64_t NpyHeader::count() const {
    std::uint64_t count = 1;
    for (const std::uint32_t length : shape) count *= length;
    return count;
}

NpyHeader parse_npy_header(const std::string& name, const std::uint8_t* data, std::size_t size) {
    static constexpr std::uint8_t magic[6] = {0x93, 'N', 'U', 'M', 'P', 'Y'};
    static constexpr std::uint8_t archive[4] = {'P', 'K', 3, 4};
    if (size >= 4 && std::memcmp(data, archive, sizeof archive) == 0)
        throw input_error(name, "it is an archive (.npz); save one array with numpy.save");
    if (size < 6 || std::memcmp(data, magic, sizeof magic) != 0)
        throw input_error(name, "it is not an .npy file; save the array with numpy.save");
    if (size < 10) throw input_error(name, "it ends in its header; copy it again");
    const unsigned major = data[6], minor = data[7];
    if (major < 1 || major > 3 || minor != 0)
        throw input_error(name, "it is of version " + std::to_string(major) + "." + std::to_string(minor) +
                                    " of the .npy format; 1.0, 2.0 and 3.0 are read");
    const std::size_t length_bytes = major == 1 ? 2 : 4, start = 8 + length_bytes;
    const std::size_t length = size < start ? 0 : little_endian(data + 8, length_bytes);
    if (length > max_header)
        throw input_error(name, "its header claims " + std::to_string(length) +
                                    " bytes, more than an array of plain numbers needs; save one with numpy.save");
    if (size < start || size - start < length) throw input_error(name, "it ends in its header; copy it again");
    const char* text = reinterpret_cast<const char*>(data + start);
    NpyHeader header = Literal(name, text, text + length).parse();
    header.size = start + length;
    return header;
}

} // namespace acdf::input
