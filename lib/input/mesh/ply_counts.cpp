#include "input/mesh/ply_counts.h"

#include "input/error.h"
#include "input/line_ends.h"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace acdf::input {
namespace {

/// A type of numbers; of no bytes: none.
struct PlyType {
    std::uint64_t bytes = 0;
    bool integer = false, is_signed = false;
};

struct PlyProperty {
    PlyType count; ///< of a list: of its length
    PlyType item;
};

struct PlyElement {
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    std::string format;
    std::vector<PlyElement> elements;
};

PlyType type_of(const std::string& name) {
    if (name == "char" || name == "int8") return {1, true, true};
    if (name == "uchar" || name == "uint8") return {1, true};
    if (name == "short" || name == "int16") return {2, true, true};
    if (name == "ushort" || name == "uint16") return {2, true};
    if (name == "int" || name == "int32") return {4, true, true};
    if (name == "uint" || name == "uint32") return {4, true};
    if (name == "float" || name == "float32") return {4};
    if (name == "double" || name == "float64") return {8};
    return {};
}

class Ply {
public:
    explicit Ply(const std::string& path) : path_(path), file_(path, std::ios::binary) {
        std::error_code error;
        size_ = std::filesystem::file_size(path, error);
        if (error) size_ = 0;
    }

    void check() {
        const PlyHeader header = read_header();
        if (header.format != "ascii") refuse_converted_line_ends(path_);
        for (const PlyElement& element : header.elements)
            if (!(header.format == "ascii" ? check_lines(element) : check_bytes(element, header.format)))
                fail("it ends before the elements that its header claims; it is cut short or damaged" +
                     (header.format == "ascii" ? "" : maybe_converted_line_ends(path_)));
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw input_error(path_, what); }
    [[noreturn]] void fail_list() const {
        fail("a list in it claims more elements than the file has bytes; it is damaged");
    }

    [[noreturn]] void fail_line() const {
        fail("a line of it has fewer numbers than its header says; it is cut short or damaged");
    }

    PlyHeader read_header() {
        PlyHeader out;
        char line[1024];
        if (size_ == 0 || !file_.getline(line, sizeof line) || std::string(line).substr(0, 3) != "ply")
            fail("it does not begin with \"ply\": it is not a PLY mesh, or damaged");
        while (file_.getline(line, sizeof line)) {
            std::istringstream words(line);
            std::string word, name;
            words >> word;
            if (word == "end_header") return out;
            if (word == "format") words >> out.format;
            if (word == "property") {
                if (out.elements.empty()) fail("its header has a property of no element; it is damaged");
                out.elements.back().properties.push_back(read_property(words));
            }
            if (word != "element") continue;
            PlyElement element;
            if (!(words >> name >> element.count) || element.count > size_)
                fail("its header claims more elements than the file has bytes; it is damaged");
            out.elements.push_back(element);
        }
        fail("its header does not end; it is cut short or damaged");
    }

    PlyProperty read_property(std::istringstream& words) const {
        PlyProperty out;
        std::string word;
        words >> word;
        const bool list = word == "list";
        if (list) {
            words >> word;
            out.count = type_of(word);
            words >> word;
        }
        out.item = type_of(word);
        if (out.item.bytes == 0 || (list && !out.count.integer))
            fail("its header has a property of a type that PLY does not have; it is damaged");
        return out;
    }

    /// An element of a text, each on its line. False where the file ends before.
    bool check_lines(const PlyElement& element) {
        std::string line;
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            if (!next_line(line)) return false;
            const char* at = line.c_str();
            for (const PlyProperty& property : element.properties) {
                std::uint64_t items = 1;
                if (property.count.bytes > 0 && !take_count(at, line.size(), items)) fail_line();
                for (; items > 0; --items)
                    if (!take_word(at)) fail_line();
            }
        }
        return true;
    }

    /// The next line that is not blank: the importer skips those that are.
    bool next_line(std::string& line) {
        while (std::getline(file_, line))
            if (line.find_first_not_of(" \t\r") != std::string::npos) return true;
        return false;
    }

    static bool take_word(const char*& at) {
        while (*at == ' ' || *at == '\t' || *at == '\r') ++at;
        const char* const begin = at;
        while (*at != '\0' && *at != ' ' && *at != '\t' && *at != '\r') ++at;
        return at != begin;
    }

    /// The length of a list in a line of so many characters; false where there is no number.
    bool take_count(const char*& at, std::size_t most, std::uint64_t& count) const {
        char* end = nullptr;
        const double value = std::strtod(at, &end);
        if (end == at) return false;
        if (!(value >= 0.0 && value <= static_cast<double>(most))) fail_list();
        at = end;
        count = static_cast<std::uint64_t>(value);
        return true;
    }

    bool check_bytes(const PlyElement& element, const std::string& format) {
        const bool big_endian = format == "binary_big_endian";
        std::uint64_t whole = 0, lists = 0;
        for (const PlyProperty& property : element.properties) {
            whole += property.item.bytes;
            lists += property.count.bytes > 0;
        }
        if (lists == 0)
            return element.count == 0 || (whole <= size_ / element.count && skip(whole * element.count));
        std::uint64_t before = 0; // bytes to the next list
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) {
                if (property.count.bytes == 0) {
                    before += property.item.bytes;
                    continue;
                }
                std::uint64_t count = 0;
                if (!skip(before) || !read_count(property.count, big_endian, count)) return false;
                if (count > size_) fail_list();
                before = count * property.item.bytes;
            }
        return skip(before);
    }

    bool skip(std::uint64_t bytes) {
        if (bytes > size_) return false;
        const auto wanted = static_cast<std::streamsize>(bytes);
        if (bytes > 0) file_.ignore(wanted);
        return file_.good() && (bytes == 0 || file_.gcount() == wanted);
    }

    /// A negative one is more than any file has: so the importer takes it.
    bool read_count(const PlyType& type, bool big_endian, std::uint64_t& count) {
        unsigned char bytes[8] = {};
        if (!file_.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(type.bytes))) return false;
        count = 0;
        for (std::uint64_t i = 0; i < type.bytes; ++i)
            count |= std::uint64_t{bytes[i]} << (8 * (big_endian ? type.bytes - 1 - i : i));
        if (type.is_signed && count >> (8 * type.bytes - 1) != 0) count = ~std::uint64_t{0};
        return true;
    }

    std::string path_;
    std::ifstream file_;
    std::uint64_t size_ = 0;
};

} // namespace

void check_ply_counts(const std::string& path) { Ply(path).check(); }

} // namespace acdf::input
