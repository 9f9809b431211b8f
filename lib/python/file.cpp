// Samples and pdfs of arrays.
#include "python/file.h"

#include <acdf/curves/curves.h>

namespace acdf::python {
namespace {

AcdfLoadOptions load_options(bool tables) {
    AcdfLoadOptions options = {};
    options.plain = !tables;
    options.curves = acdf_curves();
    return options;
}

const char* condition_name(AcdfKind kind) {
    return kind == ACDF_KIND_LOCAL ? "normals" : kind == ACDF_KIND_BRDF ? "wo" : "index";
}

const char* item_name(AcdfKind kind) { return kind == ACDF_KIND_BRDF ? "wi" : "directions"; }

/// Normals or views, and how many items each serves; of an environment none.
struct Conditions {
    Rows<float> rows;
    std::size_t each = 1;
};
Conditions conditions(const AcdfFile* file, const py::object& condition, const std::vector<py::ssize_t>& items,
                      const char* item_name) {
    const char* name = condition_name(acdf_kind(file));
    Rows<float> of = rows<float>(condition, 3, name);
    const std::size_t each = items_each(of.leading, name, items, item_name);
    return {std::move(of), each};
}

/// Indices of a table; null where it has no indexed axis.
struct Indices {
    Rows<std::uint32_t> rows;
    std::size_t each;
    const std::uint32_t* data;
};
Indices indices(const AcdfFile* file, const py::object& condition, const std::vector<py::ssize_t>& items,
                const char* item_name) {
    const auto axes = static_cast<py::ssize_t>(acdf_table_indexed_axes(file));
    if (axes == 0) {
        if (!condition.is_none()) throw py::value_error("index: the table has no indexed axis");
        return {{}, 1, nullptr};
    }
    if (condition.is_none())
        throw py::value_error("index: the table has " + std::to_string(axes) +
                              " indexed axes; give one integer each");
    const Rows<std::int64_t> wide = rows<std::int64_t>(condition, axes, "index", "iu");
    // Not within the braces below: gcc 12 destroys `rows` twice where a later member's initializer throws.
    const std::size_t each = items_each(wide.leading, "index", items, item_name);
    Indices out = {{}, each, nullptr};
    out.rows.array = new_array<std::uint32_t>(wide.leading, axes);
    std::uint32_t* to = out.rows.array.mutable_data();
    for (std::size_t i = 0; i < wide.count * static_cast<std::size_t>(axes); ++i) {
        const std::int64_t index = wide.data()[i];
        const AcdfAxis* axis = acdf_axis(file, static_cast<std::uint32_t>(i % static_cast<std::size_t>(axes)));
        if (index < 0 || index >= static_cast<std::int64_t>(axis->resolution))
            throw py::index_error("index: " + std::to_string(index) + " is out of range, the axis has " +
                                  std::to_string(axis->resolution) + " steps");
        to[i] = static_cast<std::uint32_t>(index);
    }
    out.data = to;
    return out;
}

} // namespace

void raise(const AcdfError& error) {
    if (error.code == ACDF_OUT_OF_MEMORY) PyErr_SetString(PyExc_MemoryError, error.message);
    else if (error.code == ACDF_CANNOT_OPEN || error.code == ACDF_CANNOT_READ)
        PyErr_SetString(PyExc_OSError, error.message);
    else {
        const py::object type = py::module_::import("acdf._errors").attr("FileError");
        PyErr_SetObject(type.ptr(),
                        type(py::str(error.message), static_cast<int>(error.code), error.rule, error.offset).ptr());
    }
    throw py::error_already_set();
}

std::unique_ptr<OpenFile> OpenFile::opened(AcdfFile* file, py::object keeps) {
    std::unique_ptr<OpenFile> out(new OpenFile(file, std::move(keeps)));
    AcdfError error;
    if (acdf_kind(file) == ACDF_KIND_INDEXED && !acdf_indexed(file, &out->maps_, &error)) raise(error);
    return out;
}

std::unique_ptr<OpenFile> OpenFile::from_path(const std::string& path, bool tables) {
    AcdfError error;
    const AcdfLoadOptions options = load_options(tables);
    AcdfFile* file = nullptr;
    {
        const py::gil_scoped_release release;
        file = acdf_open_with(path.c_str(), &options, &error);
    }
    if (!file) raise(error);
    return opened(file, py::none());
}

std::unique_ptr<OpenFile> OpenFile::from_bytes(const py::bytes& bytes, bool tables) {
    AcdfError error;
    const AcdfLoadOptions options = load_options(tables);
    const char* data = PyBytes_AS_STRING(bytes.ptr());
    const auto size = static_cast<std::size_t>(PyBytes_GET_SIZE(bytes.ptr()));
    AcdfFile* file = nullptr;
    {
        const py::gil_scoped_release release;
        file = acdf_from_memory_with(data, size, &options, &error);
    }
    if (!file) raise(error);
    return opened(file, bytes);
}

py::tuple OpenFile::sample(const py::object& condition, const py::object& given, const py::tuple& out) const {
    const AcdfKind kind = acdf_kind(file());
    if (kind == ACDF_KIND_TABLE) return sample_table(condition, given, out);
    const Rows<double> u = rows<double>(given, 2, "u");
    py::array_t<float> directions = output<float>(out[0], u.leading, 3), pdfs = output<float>(out[1], u.leading, 0);
    float *w = directions.mutable_data(), *p = pdfs.mutable_data();
    const Conditions at =
        kind == ACDF_KIND_ENVIRONMENT ? Conditions() : conditions(file(), condition, u.leading, "u");
    const double* numbers = u.data();
    const float* from = at.rows.data();
    {
        const py::gil_scoped_release release;
        if (kind == ACDF_KIND_BRDF) acdf_sample_brdf_array(file(), from, at.each, numbers, u.count, w, p);
        else if (kind == ACDF_KIND_LOCAL) acdf_sample_local_array(file(), from, at.each, numbers, u.count, w, p);
        else acdf_sample_environment_array(file(), numbers, u.count, w, p);
    }
    return py::make_tuple(directions, pdfs);
}

py::tuple OpenFile::sample_table(const py::object& condition, const py::object& given, const py::tuple& out) const {
    const auto axes = static_cast<py::ssize_t>(acdf_table_sampled_axes(file()));
    const Rows<double> u = rows<double>(given, axes, "u");
    const Indices at = indices(file(), condition, u.leading, "u");
    py::array_t<double> points = output<double>(out[0], u.leading, axes),
                        pdfs = output<double>(out[1], u.leading, 0);
    double *x = points.mutable_data(), *p = pdfs.mutable_data();
    const double* numbers = u.data();
    {
        const py::gil_scoped_release release;
        acdf_sample_table_array(file(), at.data, at.each, numbers, u.count, x, p);
    }
    return py::make_tuple(points, pdfs);
}

py::array OpenFile::pdf(const py::object& condition, const py::object& given, const py::object& out) const {
    const AcdfKind kind = acdf_kind(file());
    if (kind == ACDF_KIND_TABLE) {
        const Rows<double> x = rows<double>(given, static_cast<py::ssize_t>(acdf_table_sampled_axes(file())), "x");
        const Indices at = indices(file(), condition, x.leading, "x");
        py::array_t<double> pdfs = output<double>(out, x.leading, 0);
        double* p = pdfs.mutable_data();
        const double* points = x.data();
        {
            const py::gil_scoped_release release;
            acdf_pdf_table_array(file(), at.data, at.each, points, x.count, p);
        }
        return std::move(pdfs);
    }
    const char* name = item_name(kind);
    const Rows<float> w = rows<float>(given, 3, name);
    py::array_t<float> pdfs = output<float>(out, w.leading, 0);
    float* p = pdfs.mutable_data();
    const Conditions at =
        kind == ACDF_KIND_ENVIRONMENT ? Conditions() : conditions(file(), condition, w.leading, name);
    const float *directions = w.data(), *from = at.rows.data();
    {
        const py::gil_scoped_release release;
        if (kind == ACDF_KIND_BRDF) acdf_pdf_brdf_array(file(), from, at.each, directions, w.count, p);
        else if (kind == ACDF_KIND_LOCAL) acdf_pdf_local_array(file(), from, at.each, directions, w.count, p);
        else acdf_pdf_environment_array(file(), directions, w.count, p);
    }
    return std::move(pdfs);
}

py::array OpenFile::invert(const py::object& condition, const py::object& given) const {
    const AcdfKind kind = acdf_kind(file());
    const auto axes = kind == ACDF_KIND_TABLE ? static_cast<py::ssize_t>(acdf_table_sampled_axes(file())) : 2;
    if (kind == ACDF_KIND_TABLE) {
        const Rows<double> x = rows<double>(given, axes, "x");
        const Indices at = indices(file(), condition, x.leading, "x");
        py::array_t<double> numbers = new_array<double>(x.leading, axes);
        double* u = numbers.mutable_data();
        const double* points = x.data();
        {
            const py::gil_scoped_release release;
            acdf_invert_table_array(file(), at.data, at.each, points, x.count, u);
        }
        return std::move(numbers);
    }
    const char* name = item_name(kind);
    const Rows<float> w = rows<float>(given, 3, name);
    const Conditions at =
        kind == ACDF_KIND_ENVIRONMENT ? Conditions() : conditions(file(), condition, w.leading, name);
    py::array_t<double> numbers = new_array<double>(w.leading, axes);
    double* u = numbers.mutable_data();
    const float *directions = w.data(), *from = at.rows.data();
    {
        const py::gil_scoped_release release;
        if (kind == ACDF_KIND_BRDF) acdf_invert_brdf_array(file(), from, at.each, directions, w.count, u);
        else acdf_invert_environment_array(file(), directions, w.count, u);
    }
    return std::move(numbers);
}

py::array OpenFile::total_of(const py::object& condition) const {
    const AcdfKind kind = acdf_kind(file());
    const Rows<float> at = rows<float>(condition, 3, condition_name(kind));
    py::array_t<double> totals = new_array<double>(at.leading, 0);
    double* out = totals.mutable_data();
    const float* from = at.data();
    {
        const py::gil_scoped_release release;
        if (kind == ACDF_KIND_BRDF) acdf_albedo_brdf_array(file(), from, at.count, out);
        else acdf_irradiance_local_array(file(), from, at.count, out);
    }
    return std::move(totals);
}

} // namespace acdf::python
