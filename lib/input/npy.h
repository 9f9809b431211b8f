// Reads tables of numbers from .npy files, the format of numpy.save (NumPy Enhancement Proposal 1; versions 1 to
// 3).
#pragma once

#include "build/array.h"
#include "input/error.h"

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace acdf::input {

/// What stands before the numbers of a file.
struct NpyHeader {
    std::vector<std::uint32_t> shape; ///< 1 to 6 numbers, each at least 1
    std::uint32_t item_size = 0;      ///< 4 or 8: bytes of a little-endian IEEE 754 number
    bool fortran_order = false;       ///< the first axis varies fastest
    std::uint64_t size = 0;           ///< bytes before the first number

    std::uint64_t count() const; ///< of numbers
};

/// Parses the start of a file; `name` goes into messages. `size` bytes at `data` may end anywhere after the header.
/// Throws Error for anything but a plain array of float32 or float64.
NpyHeader parse_npy_header(const std::string& name, const std::uint8_t* data, std::size_t size);

using build::BadValues;
using build::index_text;

/// The numbers of a file, row-major whatever the order there.
struct NpyArray : build::Array {
    BadValues bad; ///< set to 0
};

enum class BadValuePolicy { refuse, zero };

struct NpyOptions {
    BadValuePolicy bad_values = BadValuePolicy::refuse;
};

/// Reads the file at `path`. Throws Error: one line, also for bad values unless they are to be 0.
NpyArray read_npy(const std::string& path, const NpyOptions& options = {});

/// The same for a stream at its start that holds `size` bytes.
NpyArray read_npy(std::FILE* file, std::uint64_t size, const std::string& name, const NpyOptions& options = {});

} // namespace acdf::input
