#include "compress/halvings/halvings.h"

#include "compress/halvings/bit_writer.h"

#include <acdf/layout.h>

#include <cstring>

namespace acdf::compress {

std::size_t halvings_bytes(std::size_t leaves, std::uint32_t axis_bits, std::uint32_t code_bits,
                           std::size_t trees) {
    const std::size_t halvings = leaves - trees;
    const std::size_t structure = leaves + halvings + halvings * axis_bits, codes = halvings * code_bits;
    return sizeof(AcdfHalvingsHeader) + (structure + 31) / 32 * 4 + (codes + 31) / 32 * 4;
}

std::uint32_t axis_bits_for(std::size_t axes) {
    std::uint32_t bits = 0;
    while (std::size_t{1} << bits < axes) ++bits;
    return bits;
}

void halvings_chunk(const Halvings& halvings, std::vector<std::uint8_t>& bytes) {
    const AcdfHalvingsHeader header = {static_cast<std::uint32_t>(halvings.codes.size()), halvings.code_bits, {}};
    bytes.resize(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    BitWriter bits(bytes);
    for (const std::int8_t axis : halvings.axes)
        if (axis < 0) bits.put(0, 1);
        else bits.put(1u | static_cast<std::uint32_t>(axis) << 1, 1 + halvings.axis_bits);
    bits.pad();
    for (const std::uint16_t code : halvings.codes) bits.put(code, halvings.code_bits);
    bits.pad();
}

std::vector<std::uint8_t> halvings_chunk(const Halvings& halvings) {
    std::vector<std::uint8_t> bytes;
    halvings_chunk(halvings, bytes);
    return bytes;
}

} // namespace acdf::compress
