#include "python/arrays.h"

#include <cstring>

namespace acdf::python {

std::string shape_text(const std::vector<py::ssize_t>& shape) {
    std::string text = "(";
    for (std::size_t i = 0; i < shape.size(); ++i) text += (i ? ", " : "") + std::to_string(shape[i]);
    return text + (shape.size() == 1 ? ",)" : ")");
}

py::array numbers(const py::handle& given, const char* name, const char* kinds) {
    const py::array array = py::array::ensure(given);
    if (!array) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + ": not an array of numbers");
    }
    if (!std::strchr(kinds, array.dtype().kind())) {
        const std::string dtype = py::str(array.dtype());
        const char* wanted = std::strchr(kinds, 'f') ? "real numbers" : "integers";
        throw py::type_error(std::string(name) + ": expected " + wanted + ", got an array of " + dtype);
    }
    return array;
}

void no_memory(const char* name) {
    PyErr_Format(PyExc_MemoryError, "%s: no memory for a copy in the layout that acdf uses", name);
    throw py::error_already_set();
}

std::vector<py::ssize_t> leading_shape(const py::array& array, py::ssize_t width, const char* name) {
    std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
    if (shape.empty() || shape.back() != width)
        throw py::value_error(std::string(name) + ": expected shape (..., " + std::to_string(width) + "), got " +
                              shape_text(shape));
    shape.pop_back();
    return shape;
}

py::array checked_output(const py::object& given, const py::dtype& type, const std::vector<py::ssize_t>& shape) {
    if (!py::isinstance<py::array>(given)) throw py::type_error("out: not an array");
    const auto array = py::reinterpret_borrow<py::array>(given);
    constexpr int packed = py::array::c_style | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    const bool fits = std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) == shape;
    if (!fits || !array.dtype().equal(type) || (array.flags() & packed) != packed || !array.writeable())
        throw py::value_error("out: expected a contiguous, writable array of " +
                              py::str(py::object(type)).cast<std::string>() + " and shape " + shape_text(shape));
    return array;
}

std::size_t items_each(const std::vector<py::ssize_t>& leading, const char* condition_name,
                       const std::vector<py::ssize_t>& items, const char* item_name) {
    bool begins = leading.size() <= items.size();
    for (std::size_t i = 0; begins && i < leading.size(); ++i) begins = leading[i] == items[i];
    if (!begins)
        throw py::value_error(std::string(condition_name) + ": its leading shape " + shape_text(leading) +
                              " does not begin that of " + item_name + ", " + shape_text(items));
    std::size_t each = 1;
    for (std::size_t i = leading.size(); i < items.size(); ++i) each *= static_cast<std::size_t>(items[i]);
    return each ? each : 1;
}

} // namespace acdf::python
