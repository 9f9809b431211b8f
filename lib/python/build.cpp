// Files from arrays, by acdf::builder.
#include "python/options.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>

namespace acdf::python {
namespace {

using namespace acdf::builder;
using builder::ErrorCode; // and not those of the reader
using builder::Status;

/// What Python code that is called while a file is built raised first; it is raised again when the build has ended.
class Raised {
public:
    /// Runs `call` with the interpreter's lock; false where it raised, now or before.
    template <class Call>
    bool run(Call&& call) {
        const py::gil_scoped_acquire acquire;
        if (first_) return false;
        try {
            call();
            return true;
        } catch (...) {
            first_ = std::current_exception();
            return false;
        }
    }
    void again() const {
        if (first_) std::rethrow_exception(first_);
    }

private:
    std::exception_ptr first_; // guarded by the interpreter's lock
};

/// Threads, and progress: reported to Python on request, with a check for interrupts of the user.
Control control_of(const Options& options, Raised& raised) {
    Control control;
    options.take("threads", control.threads);
    const py::object progress = options.has("progress") ? options.get("progress") : py::none();
    using Clock = std::chrono::steady_clock;
    control.progress = [progress = progress.ptr(), &raised, last = Clock::now()](double share,
                                                                                 const char* what) mutable {
        const Clock::time_point now = Clock::now();
        if (progress == Py_None && now - last < std::chrono::milliseconds(100)) return true;
        last = now;
        bool go_on = true;
        const bool fine = raised.run([&] {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (progress == Py_None) return;
            const py::object answer = py::reinterpret_borrow<py::object>(progress)(share, what);
            go_on = answer.is_none() || answer.cast<bool>();
        });
        return fine && go_on;
    };
    return control;
}

[[noreturn]] void raise(const Status& status) {
    if (status.code == ErrorCode::out_of_memory) PyErr_SetString(PyExc_MemoryError, status.message);
    else if (status.code == ErrorCode::invalid_argument) PyErr_SetString(PyExc_ValueError, status.message);
    else {
        const py::object type = py::module_::import("acdf._errors").attr("BuildError");
        PyErr_SetObject(type.ptr(), type(py::str(status.message), static_cast<int>(status.code)).ptr());
    }
    throw py::error_already_set();
}

/// The bytes of a file that `make` builds without the interpreter's lock. `raised` is what its callbacks write to.
template <class Result>
py::bytes built(const Options& options, Raised& raised,
                const std::function<Status(Result& result, const Control& control)>& make) {
    const Control control = control_of(options, raised);
    Result made;
    Status status;
    {
        const py::gil_scoped_release release;
        status = make(made, control);
    }
    raised.again();
    if (!status.ok()) raise(status);
    return py::bytes(reinterpret_cast<const char*>(made.bytes.data()), made.bytes.size());
}

Pixels pixels_of(const Numbers& image, const Options& options) {
    const py::array& array = image.array;
    const bool grey = array.ndim() == 2;
    if (!grey && array.ndim() != 3)
        throw py::value_error("image: expected shape (height, width) or (height, width, 1, 3 or 4), got " +
                              shape_text({array.shape(), array.shape() + array.ndim()}));
    for (int axis = 0; axis < 2; ++axis)
        if (array.shape(axis) > 65536) throw py::value_error("image: at most 65536 pixels on a side");
    Pixels pixels;
    pixels.data = array.data();
    pixels.height = static_cast<std::uint32_t>(array.shape(0));
    pixels.width = static_cast<std::uint32_t>(array.shape(1));
    pixels.channels = grey ? 1u : static_cast<std::uint32_t>(std::min<py::ssize_t>(array.shape(2), 1000));
    pixels.number = image.number;
    pixels.row_stride = array.strides(0);
    pixels.pixel_stride = array.strides(1);
    pixels.channel_stride = grey ? 0 : array.strides(2);
    options.choose<Projection>("projection",
                               {{"latlong", Projection::latlong},
                                {"angular", Projection::angular},
                                {"mirrorball", Projection::mirrorball},
                                {"vertical-cross", Projection::vertical_cross},
                                {"horizontal-cross", Projection::horizontal_cross},
                                {"stacked-cube", Projection::stacked_cube},
                                {"octahedral", Projection::octahedral}},
                               pixels.projection);
    return pixels;
}

py::bytes build_environment(const py::object& image, const py::dict& given) {
    const Options options(given);
    const Numbers held = number_array(image, "image");
    const Pixels pixels = pixels_of(held, options);
    const EnvironmentOptions what = environment_options(options);
    Raised raised;
    return built<Environment>(options, raised, [&](Environment& result, const Control& control) {
        return environment(pixels, what, result, control);
    });
}

py::bytes build_indexed(const std::vector<py::object>& images, const py::dict& given) {
    const Options options(given);
    std::vector<Numbers> held;
    std::vector<Pixels> maps;
    for (const py::object& image : images) {
        held.push_back(number_array(image, "maps"));
        maps.push_back(pixels_of(held.back(), options));
    }
    const IndexedOptions what = indexed_options(options);
    Raised raised;
    return built<IndexedFile>(options, raised, [&](IndexedFile& result, const Control& control) {
        return indexed(maps, what, result, control);
    });
}

py::bytes build_local(const py::object& image, const py::dict& given) {
    const Options options(given);
    const Numbers held = number_array(image, "image");
    const Pixels pixels = pixels_of(held, options);
    const LocalOptions what = local_options(options);
    Raised raised;
    return built<Local>(options, raised, [&](Local& result, const Control& control) {
        return local(pixels, what, result, control);
    });
}

Array array_of(const Numbers& numbers) {
    Array out;
    out.data = numbers.array.data();
    out.number = numbers.number;
    for (py::ssize_t i = 0; i < numbers.array.ndim(); ++i) {
        if (numbers.array.shape(i) > 0xFFFFFFFFll) throw py::value_error("array: an axis is too long");
        out.shape.push_back(static_cast<std::uint32_t>(numbers.array.shape(i)));
        out.strides.push_back(numbers.array.strides(i));
    }
    return out;
}

/// A function of Python as a BRDF: rho(wo, wi), each a tuple of three numbers, is one number or three.
Brdf called_brdf(const py::object& function, const Options& options, Raised& raised) {
    Brdf brdf;
    options.take("isotropic", brdf.isotropic);
    options.take("mirrored", brdf.mirrored);
    brdf.evaluate = [function = function.ptr(), &raised](const double* wo, const double* wi, double* rgb) {
        const bool fine = raised.run([&] {
            const py::object value = py::reinterpret_borrow<py::object>(function)(
                py::make_tuple(wo[0], wo[1], wo[2]), py::make_tuple(wi[0], wi[1], wi[2]));
            // NumPy takes None for NaN, and ensure() forgets what it raised.
            using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;
            const auto all = value.is_none() ? Values() : Values::ensure(value);
            if (value.is_none() || !all)
                throw py::type_error("the BRDF returned a " +
                                     std::string(py::str(py::type::of(value).attr("__name__"))) +
                                     ", not one number or three");
            if (all.size() != 1 && all.size() != 3)
                throw py::value_error("the BRDF returned " + std::to_string(all.size()) + " numbers, not 1 or 3");
            for (int c = 0; c < 3; ++c) rgb[c] = all.data()[all.size() == 1 ? 0 : c];
        });
        if (!fine) throw std::runtime_error("the BRDF raised an exception"); // ends the build
    };
    return brdf;
}

py::bytes build_brdf(const py::object& source, const py::dict& given) {
    const Options options(given);
    const BrdfOptions what = brdf_options(options);
    Raised raised;
    Brdf from;
    if (PyCallable_Check(source.ptr())) {
        from = called_brdf(source, options, raised);
    } else {
        const Numbers held = number_array(source, "table");
        const Status status = tabulated(array_of(held), from); // copies it
        if (!status.ok()) raise(status);
    }
    return built<BrdfFile>(options, raised, [&](BrdfFile& result, const Control& control) {
        return brdf(from, what, result, control);
    });
}

py::bytes build_table(const py::object& array, const py::dict& given) {
    const Options options(given);
    const Numbers held = number_array(array, "array");
    const Array numbers = array_of(held);
    const TableOptions what = table_options(options);
    Raised raised;
    return built<Table>(options, raised, [&](Table& result, const Control& control) {
        return table(numbers, what, result, control);
    });
}

/// EnvironmentRebuilder, whose frames are copied as bytes.
class Rebuilder {
public:
    Rebuilder(std::uint32_t width, std::uint32_t height, const py::dict& given) {
        const Options options(given);
        Quality quality = Quality::fast;
        Projection projection = Projection::latlong;
        options.choose<Quality>("quality", {{"fast", Quality::fast}, {"best", Quality::best}}, quality);
        options.choose<Projection>(
            "projection", {{"latlong", Projection::latlong}, {"octahedral", Projection::octahedral}}, projection);
        pixels_options_["projection"] = projection == Projection::latlong ? "latlong" : "octahedral";
        const Status status =
            EnvironmentRebuilder::make(width, height, environment_options(options), made_, quality, projection);
        if (!status.ok()) raise(status);
    }

    /// `region`: None, or x, y, width and height.
    py::bytes rebuild(const py::object& image, const py::object& region, int threads) {
        const Numbers held = number_array(image, "image");
        const Pixels pixels = pixels_of(held, Options(pixels_options_));
        Region part;
        if (!region.is_none()) {
            const auto numbers = region.cast<std::array<std::uint32_t, 4>>();
            part = {numbers[0], numbers[1], numbers[2], numbers[3]};
        }
        Control control;
        control.threads = threads;
        Status status;
        {
            const py::gil_scoped_release release;
            status = region.is_none() ? made_.rebuild(pixels, control) : made_.update(pixels, part, control);
        }
        if (!status.ok()) raise(status);
        return py::bytes(reinterpret_cast<const char*>(made_.data()), made_.size());
    }
    double relative_variance() const { return made_.empty() ? 0.0 : made_.relative_variance(); }

private:
    EnvironmentRebuilder made_;
    py::dict pixels_options_;
};

} // namespace

void add_build(py::module_& module) {
    py::class_<Rebuilder>(module, "Rebuilder")
        .def(py::init<std::uint32_t, std::uint32_t, const py::dict&>())
        .def("rebuild", &Rebuilder::rebuild)
        .def("relative_variance", &Rebuilder::relative_variance);
    module.def("build_environment", &build_environment);
    module.def("build_indexed", &build_indexed);
    module.def("build_local", &build_local);
    module.def("build_brdf", &build_brdf);
    module.def("build_table", &build_table);
}

} // namespace acdf::python
