// The container of the RGL material database: "tensor_file", version 1.0 (Dupuy and Jakob 2018, supplement).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace acdf::input {

enum class TensorType : std::uint8_t {
    uint8 = 1,
    int8,
    uint16,
    int16,
    uint32,
    int32,
    uint64,
    int64,
    float16,
    float32,
    float64
};

/// An array of numbers, row-major.
struct TensorField {
    std::string name;
    TensorType type;
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 0;            ///< product of `shape`
    const std::uint8_t* data = nullptr; ///< into the file; not aligned
};

/// The named arrays of a file. Layout, little-endian: "tensor_file\0", version (u8 major, u8 minor), u32 fields;
/// each field: u16 length and name, u16 dimensions, u8 type, u64 offset of its numbers in the file, u64 per
/// dimension.
class TensorFile {
public:
    /// Keeps pointers into `data`. `name` goes into messages. Throws Error unless every field lies inside the file.
    TensorFile(const std::string& name, const std::uint8_t* data, std::size_t size);

    static bool has_magic(const std::uint8_t* data, std::size_t size);

    const TensorField* find(const std::string& field) const; ///< null: there is none

    /// The numbers of a field of type float32 and of that many dimensions; throws Error if it is anything
    /// else.
    const TensorField& floats(const std::string& field, std::size_t dimensions) const;

    const std::string& name() const { return name_; }

private:
    std::string name_;
    std::vector<TensorField> fields_;
};

} // namespace acdf::input
