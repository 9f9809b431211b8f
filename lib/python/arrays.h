// Arrays of NumPy as packed rows of numbers: what the C interface takes. Nothing is copied whose type and layout
// are right already.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace acdf::python {

namespace py = pybind11;

/// An array of shape (..., width).
template <class T>
struct Rows {
    py::array_t<T, py::array::c_style> array;
    std::vector<py::ssize_t> leading; ///< the shape without its last axis
    std::size_t count = 1;            ///< product of `leading`

    const T* data() const { return array.data(); }
};

/// "(2, 3)", as Python writes it.
std::string shape_text(const std::vector<py::ssize_t>& shape);

/// The numbers of `given` as an array. `name` is that of the argument, for messages; `kinds` are those of dtypes
/// that will do: "f" floating point, "i" and "u" integers. Raises TypeError.
py::array numbers(const py::handle& given, const char* name, const char* kinds);

/// Raises MemoryError: an argument could not be copied.
[[noreturn]] void no_memory(const char* name);

/// Raises ValueError unless the last axis is of that width.
std::vector<py::ssize_t> leading_shape(const py::array& array, py::ssize_t width, const char* name);

template <class T>
Rows<T> rows(const py::handle& given, py::ssize_t width, const char* name, const char* kinds = "fiu") {
    const py::array array = numbers(given, name, kinds);
    Rows<T> out;
    out.leading = leading_shape(array, width, name);
    for (const py::ssize_t n : out.leading) out.count *= static_cast<std::size_t>(n);
    constexpr int flags = py::array::c_style | py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    out.array = py::array_t<T, py::array::c_style>::ensure(py::array_t<T, flags>::ensure(array));
    if (!out.array) no_memory(name); // numbers of these kinds convert
    return out;
}

/// How many items that follow one another each of `leading` serves: its leading shape begins that of the items.
/// Raises ValueError where it does not.
std::size_t items_each(const std::vector<py::ssize_t>& leading, const char* condition_name,
                       const std::vector<py::ssize_t>& items, const char* item_name);

/// Raises unless `given` can be written to as a packed array of that type and shape.
py::array checked_output(const py::object& given, const py::dtype& type, const std::vector<py::ssize_t>& shape);

/// An array of shape (leading..., width), or (leading...) where width is 0: `given`, or a new one where that is
/// None.
template <class T>
py::array_t<T> output(const py::object& given, const std::vector<py::ssize_t>& leading, py::ssize_t width) {
    std::vector<py::ssize_t> shape = leading;
    if (width > 0) shape.push_back(width);
    if (given.is_none()) return py::array_t<T>(shape);
    return py::array_t<T>(checked_output(given, py::dtype::of<T>(), shape));
}
template <class T>
py::array_t<T> new_array(const std::vector<py::ssize_t>& leading, py::ssize_t width) {
    return output<T>(py::none(), leading, width);
}

} // namespace acdf::python
