#include "input/brdf/rgl_tensor.h"

#include "input/error.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace acdf::input {
namespace {

constexpr char magic[12] = "tensor_file";
constexpr std::uint32_t max_fields = 256;
constexpr std::size_t max_tensor_dimensions = 8, max_name = 256;
constexpr std::size_t type_size[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/// Reads numbers one after the other, never past the end.
class Cursor {
public:
    Cursor(const std::string& name, const std::uint8_t* data, std::size_t size)
        : name_(name), data_(data), size_(size) {}

    template <class Number>
    Number number() {
        Number value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    std::string text(std::size_t length) {
        const auto* const begin = reinterpret_cast<const char*>(take(length));
        return std::string(begin, length);
    }
    const std::uint8_t* take(std::size_t count) {
        if (count > size_ - at_) fail("its list of fields is cut short");
        at_ += count;
        return data_ + (at_ - count);
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw input_error(name_, "this tensor file is damaged: " + what + "; copy it again");
    }
    const std::uint8_t* begin() const { return data_; }
    std::size_t size() const { return size_; }

private:
    const std::string& name_;
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

std::string field_name(Cursor& file) {
    const auto length = file.number<std::uint16_t>();
    if (length == 0 || length > max_name) file.fail("a field's name has " + std::to_string(length) + " bytes");
    const std::string name = file.text(length);
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
        file.fail("a field's name is not made of letters");
    return name;
}

TensorField read_field(Cursor& file) {
    TensorField field;
    field.name = field_name(file);
    const auto dimensions = file.number<std::uint16_t>();
    const auto type = file.number<std::uint8_t>();
    const auto offset = file.number<std::uint64_t>();
    if (dimensions > max_tensor_dimensions)
        file.fail("field '" + field.name + "' has " + std::to_string(dimensions) + " dimensions");
    if (type == 0 || type > static_cast<std::uint8_t>(TensorType::float64))
        file.fail("field '" + field.name + "' has the unknown type " + std::to_string(type));
    field.type = static_cast<TensorType>(type);
    field.count = 1;
    bool outside = offset > file.size();
    const std::uint64_t room = outside ? 0 : (file.size() - offset) / type_size[type];
    for (std::uint16_t i = 0; i < dimensions; ++i) {
        const auto length = file.number<std::uint64_t>();
        outside |= length > 0 && field.count > room / length;
        field.count = outside ? 0 : field.count * length;
        field.shape.push_back(length);
    }
    if (outside || field.count > room) file.fail("field '" + field.name + "' does not lie inside it");
    field.data = file.begin() + offset;
    return field;
}

} // namespace

bool TensorFile::has_magic(const std::uint8_t* data, std::size_t size) {
    return size >= sizeof magic && std::memcmp(data, magic, sizeof magic) == 0;
}

TensorFile::TensorFile(const std::string& name, const std::uint8_t* data, std::size_t size) : name_(name) {
    if (!has_magic(data, size))
        throw input_error(name, "it is not a tensor file; give a .bsdf file of the RGL database");
    Cursor file(name_, data, size);
    file.take(sizeof magic);
    const auto major = file.number<std::uint8_t>(), minor = file.number<std::uint8_t>();
    if (major != 1 || minor != 0)
        throw input_error(name, "it is a tensor file of version " + std::to_string(major) + "." +
                                    std::to_string(minor) + "; this program reads 1.0");
    const auto count = file.number<std::uint32_t>();
    if (count > max_fields) file.fail("it has " + std::to_string(count) + " fields");
    for (std::uint32_t i = 0; i < count; ++i) {
        TensorField field = read_field(file);
        if (find(field.name)) file.fail("field '" + field.name + "' comes twice");
        fields_.push_back(std::move(field));
    }
}

const TensorField* TensorFile::find(const std::string& name) const {
    const auto at = std::find_if(fields_.begin(), fields_.end(), [&](const auto& f) { return f.name == name; });
    return at == fields_.end() ? nullptr : &*at;
}

const TensorField& TensorFile::floats(const std::string& name, std::size_t dimensions) const {
    const TensorField* const field = find(name);
    if (!field) throw input_error(name_, "field '" + name + "' is missing; give a .bsdf file of the RGL database");
    if (field->type != TensorType::float32 || field->shape.size() != dimensions)
        throw input_error(name_, "field '" + name + "' is not " + std::to_string(dimensions) +
                                     "-dimensional float32; give a .bsdf file of the RGL database");
    return *field;
}

} // namespace acdf::input
