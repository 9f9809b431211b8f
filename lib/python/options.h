// Options of the builder from a dictionary of Python values, whose names are those of the command line.
#pragma once

#include "python/arrays.h"

#include <acdf/renderers.h>

#include <initializer_list>
#include <string>
#include <utility>

namespace acdf::python {

/// Values that are None or missing leave what stands there. Messages name the option.
class Options {
public:
    explicit Options(py::dict values) : values_(std::move(values)) {}

    bool has(const char* name) const { return values_.contains(name) && !values_[name].is_none(); }
    py::object get(const char* name) const { return py::object(values_[name]); }

    template <class T>
    void take(const char* name, T& out) const {
        if (!has(name)) return;
        try {
            out = get(name).cast<T>();
        } catch (const py::cast_error&) {
            throw py::type_error(std::string(name) + ": " + text_of(name) +
                                 " is of the wrong type or out of range");
        }
    }
    /// One of several names.
    template <class T>
    void choose(const char* name, std::initializer_list<std::pair<const char*, T>> choices, T& out) const {
        if (!has(name)) return;
        const py::object value = get(name);
        std::string names;
        for (const auto& [text, choice] : choices) {
            if (py::isinstance<py::str>(value) && value.cast<std::string>() == text) {
                out = choice;
                return;
            }
            names += (names.empty() ? "" : ", ") + std::string(text);
        }
        throw py::value_error(std::string(name) + ": " + text_of(name) + " is none of " + names);
    }

private:
    std::string text_of(const char* name) const { return py::str(py::repr(get(name))); }

    py::dict values_;
};

/// An array as the builder reads it in place: any strides, half, float or double. Copies other numbers.
struct Numbers {
    py::array array; ///< keeps the memory
    builder::Number number;
};
Numbers number_array(const py::object& given, const char* name);

builder::Goal goal_of(const Options& options, const builder::Goal& otherwise);
AcdfCodec codec_of(const Options& options);
builder::Channels channels_of(const Options& options, const builder::Channels& otherwise = {});
builder::EnvironmentOptions environment_options(const Options& options);
builder::LocalOptions local_options(const Options& options);
builder::BrdfOptions brdf_options(const Options& options);
builder::TableOptions table_options(const Options& options);
builder::IndexedOptions indexed_options(const Options& options);

/// Adds functions that build to the module.
void add_build(py::module_& module);
/// Adds the table of renderers.
void add_renderers(py::module_& module);

} // namespace acdf::python
