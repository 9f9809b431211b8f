#include "input/brdf/table.h"

#include "build/brdf_table.h"
#include "input/error.h"

#include <stdexcept>

namespace acdf::input {

std::unique_ptr<Brdf> brdf_of_table(const std::string& name, NpyArray table) try {
    const std::uint64_t negative = table.bad.negative;
    const std::size_t count = table.values.size();
    std::unique_ptr<Brdf> brdf = build::brdf_of_table(std::move(table));
    brdf->name = name;
    if (negative > 0)
        brdf->notes.push_back(std::to_string(negative) + " of " + std::to_string(count) +
                              " numbers are negative and taken as 0");
    return brdf;
} catch (const std::invalid_argument& error) {
    throw input_error(name, std::string(error.what()) +
                                "; reshape it with numpy.reshape, or compress it with acdf table");
}

std::unique_ptr<Brdf> read_brdf_npy(const std::string& path, const std::string& name) {
    NpyOptions options;
    options.bad_values = BadValuePolicy::zero;
    NpyArray table = read_npy(path, options);
    if (table.bad.nan + table.bad.infinite > 0)
        throw input_error(path, std::to_string(table.bad.nan + table.bad.infinite) +
                                    " of its numbers are NaN or infinite, the first bad one at [" +
                                    index_text(table.shape, table.bad.first) + "]; save it again without them");
    return brdf_of_table(name, std::move(table));
}

} // namespace acdf::input
