// An environment of several maps at some coordinates: samples and pdfs of arrays.
#include "python/file.h"

#include <pybind11/stl.h>

#include <acdf/indexed/indexed.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace acdf::python {
namespace {

/// Keeps the file alive.
struct Mixed {
    py::object keeps;
    AcdfMixed sky;

    py::tuple sample(const py::object& given, const py::tuple& out) const {
        const Rows<double> u = rows<double>(given, 2, "u");
        py::array_t<float> directions = output<float>(out[0], u.leading, 3),
                           pdfs = output<float>(out[1], u.leading, 0);
        float *w = directions.mutable_data(), *p = pdfs.mutable_data();
        const double* numbers = u.data();
        {
            const py::gil_scoped_release release;
            for (std::size_t i = 0; i < u.count; ++i) {
                const AcdfDirectionSample s = acdf_mixed_sample(&sky, numbers[2 * i], numbers[2 * i + 1]);
                std::copy(s.direction, s.direction + 3, w + 3 * i);
                p[i] = s.pdf;
            }
        }
        return py::make_tuple(directions, pdfs);
    }

    py::array pdf(const py::object& given, const py::object& out) const {
        const Rows<float> w = rows<float>(given, 3, "directions");
        py::array_t<float> pdfs = output<float>(out, w.leading, 0);
        float* p = pdfs.mutable_data();
        const float* directions = w.data();
        {
            const py::gil_scoped_release release;
            for (std::size_t i = 0; i < w.count; ++i) p[i] = acdf_mixed_pdf(&sky, directions + 3 * i);
        }
        return std::move(pdfs);
    }

    py::array invert(const py::object& given) const {
        const Rows<float> w = rows<float>(given, 3, "directions");
        py::array_t<double> numbers = new_array<double>(w.leading, 2);
        double* u = numbers.mutable_data();
        const float* directions = w.data();
        {
            const py::gil_scoped_release release;
            for (std::size_t i = 0; i < w.count; ++i)
                if (!acdf_mixed_invert(&sky, directions + 3 * i, u + 2 * i))
                    u[2 * i] = u[2 * i + 1] = std::numeric_limits<double>::quiet_NaN();
        }
        return std::move(numbers);
    }
};

std::unique_ptr<Mixed> mixed_at(const py::object& file, const std::vector<double>& coordinates) {
    const AcdfIndexed& indexed = file.cast<const OpenFile&>().maps();
    if (indexed.axes == 0 || coordinates.size() != indexed.axes)
        throw py::value_error("a coordinate is needed for each axis of maps");
    auto out = std::make_unique<Mixed>();
    out->keeps = file;
    acdf_indexed_at(&indexed, coordinates.data(), &out->sky);
    return out;
}

} // namespace

void add_indexed(py::module_& module) {
    py::class_<Mixed>(module, "Mixed")
        .def("sample", &Mixed::sample)
        .def("pdf", &Mixed::pdf)
        .def("invert", &Mixed::invert)
        .def("total", [](const Mixed& mixed) { return mixed.sky.total; })
        .def("sun_share", [](const Mixed& mixed) { return mixed.sky.sun_share; });
    module.def("mixed_at", &mixed_at);
}

} // namespace acdf::python
