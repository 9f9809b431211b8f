#include "input/npy.h"

#include "input/error.h"
#include "input/file_name.h"
#include "input/line_ends.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <numeric>

#include <sys/stat.h>

namespace acdf::input {
namespace {

constexpr std::size_t block_items = std::size_t{1} << 16;

/// Reads the numbers of a file block by block, as often as asked.
class Numbers {
public:
    Numbers(std::FILE* file, const NpyHeader& header, const std::string& name)
        : file_(file), header_(header), name_(name), count_(header.count()) {}

    /// Calls visit(i, value) for each number in the order of the file.
    template <class Visit>
    void each(const Visit& visit) {
        if (std::fseek(file_, static_cast<long>(header_.size), SEEK_SET) != 0) fail();
        std::vector<std::uint8_t> block(block_items * header_.item_size);
        for (std::uint64_t begin = 0; begin < count_; begin += block_items) {
            const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(block_items, count_ - begin));
            if (std::fread(block.data(), header_.item_size, n, file_) != n) fail();
            if (header_.item_size == 4) visit_block<float>(block.data(), begin, n, visit);
            else visit_block<double>(block.data(), begin, n, visit);
        }
    }

private:
    template <class Number, class Visit>
    static void visit_block(const std::uint8_t* block, std::uint64_t begin, std::size_t n, const Visit& visit) {
        for (std::size_t i = 0; i < n; ++i) {
            Number value;
            std::memcpy(&value, block + i * sizeof value, sizeof value);
            visit(begin + i, static_cast<double>(value));
        }
    }
    [[noreturn]] void fail() const {
        throw input_error(name_, std::ferror(file_) ? std::string("it cannot be read: ") + std::strerror(errno)
                                                    : "it ended while it was read; copy it again");
    }

    std::FILE* file_;
    const NpyHeader& header_;
    const std::string& name_;
    std::uint64_t count_;
};

/// From the order of the file to row-major.
class Order {
public:
    explicit Order(const NpyHeader& header) : fortran_(header.fortran_order), shape_(header.shape) {}

    std::uint64_t row_major(std::uint64_t in_file) const {
        if (!fortran_) return in_file;
        std::uint64_t out = 0, stride = 1;
        for (const std::uint32_t length : shape_) stride *= length;
        for (const std::uint32_t length : shape_) {
            stride /= length;
            out += in_file % length * stride;
            in_file /= length;
        }
        return out;
    }

private:
    bool fortran_;
    const std::vector<std::uint32_t>& shape_;
};

build::Survey survey(Numbers& numbers, const Order& order) {
    build::Survey out;
    numbers.each([&](std::uint64_t i, double value) { out.add(value, order.row_major(i)); });
    return out;
}

NpyArray convert(Numbers& numbers, const NpyHeader& header, const build::Survey& found) {
    const Order order(header);
    NpyArray array;
    array.shape = header.shape;
    array.bad = found.bad;
    const double factor = header.item_size == 4 ? 1.0 : found.factor();
    array.scale = 1.0 / factor;
    array.values.resize(header.count());
    numbers.each(
        [&](std::uint64_t i, double value) { array.values[order.row_major(i)] = build::scaled(value, factor); });
    return array;
}

void check_size(const std::string& name, const NpyHeader& header, std::uint64_t size) {
    const std::uint64_t needed = header.size + header.count() * header.item_size;
    if (size < needed)
        throw input_error(name, "it is cut short" + maybe_converted_line_ends(name) + ": its shape needs " +
                                    std::to_string(needed) + " bytes, it has " + std::to_string(size) +
                                    "; copy it again");
    if (size > needed)
        throw input_error(name, std::to_string(size - needed) +
                                    " bytes follow its array; save one array a file with numpy.save");
}

} // namespace

NpyArray read_npy(std::FILE* file, std::uint64_t size, const std::string& name, const NpyOptions& options) {
    std::vector<std::uint8_t> start(static_cast<std::size_t>(std::min<std::uint64_t>(size, 12 + 65535)));
    const std::size_t got = std::fread(start.data(), 1, start.size(), file);
    const NpyHeader header = parse_npy_header(name, start.data(), got);
    check_size(name, header, size); // before anything is allocated for it
    try {
        Numbers numbers(file, header, name);
        const build::Survey found = survey(numbers, Order(header));
        if (found.bad.count() > 0 && options.bad_values == BadValuePolicy::refuse)
            throw input_error(name, build::text(found.bad, header.shape) + "; --bad-values zero takes them as 0");
        return convert(numbers, header, found);
    } catch (const std::bad_alloc&) {
        throw input_error(name, "there is not enough memory for its numbers; reduce its resolution");
    }
}

NpyArray read_npy(const std::string& path, const NpyOptions& options) {
    require_regular_file(path, "an .npy file"); // before it is opened: a pipe without a writer would never be
    refuse_converted_line_ends(path, 1);        // its header ends in LF
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw input_error(path, std::string("it cannot be opened: ") + std::strerror(errno));
    struct stat status = {};
    if (fstat(fileno(file.get()), &status) != 0)
        throw input_error(path, std::string("it cannot be read: ") + std::strerror(errno));
    return read_npy(file.get(), static_cast<std::uint64_t>(status.st_size), path, options);
}

} // namespace acdf::input
