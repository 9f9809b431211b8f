// An open file as Python holds it: over the C interface alone (acdf/acdf.h).
#pragma once

#include "python/arrays.h"

#include <acdf/acdf.h>
#include <acdf/arrays/arrays.h>
#include <acdf/indexed/open.h>

#include <atomic>
#include <memory>
#include <vector>

namespace acdf::python {

/// Keeps what it reads alive. Loops over arrays run without the interpreter's lock.
class OpenFile {
public:
    static std::unique_ptr<OpenFile> from_path(const std::string& path, bool tables);
    /// Uses the bytes in condition: they cannot change.
    static std::unique_ptr<OpenFile> from_bytes(const py::bytes& bytes, bool tables);

    ~OpenFile() { acdf_indexed_close(&maps_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    const AcdfFile* file() const { return file_.get(); }
    /// Of a file of several maps; zero of others.
    const AcdfIndexed& maps() const { return maps_; }
    /// Directions (or points) and their pdfs. `condition`: normals, views, indices; None for environments.
    /// `out`: where they are written, or None for new arrays.
    py::tuple sample(const py::object& condition, const py::object& u, const py::tuple& out) const;
    py::array pdf(const py::object& condition, const py::object& x, const py::object& out) const;
    py::array invert(const py::object& condition, const py::object& x) const;
    /// Irradiance of normals, or albedo of views.
    py::array total_of(const py::object& condition) const;

private:
    struct Close {
        void operator()(AcdfFile* file) const { acdf_close(file); }
    };

    explicit OpenFile(AcdfFile* file, py::object keeps) : keeps_(std::move(keeps)), file_(file) {}
    /// With its maps, if it has some.
    static std::unique_ptr<OpenFile> opened(AcdfFile* file, py::object keeps);
    py::tuple sample_table(const py::object& condition, const py::object& u, const py::tuple& out) const;

    py::object keeps_;
    std::unique_ptr<AcdfFile, Close> file_;
    AcdfIndexed maps_ = {};
};

/// Adds OpenFile to the module.
void add_file(py::module_& module);
/// Adds environments of several maps at some coordinates.
void add_indexed(py::module_& module);

/// Raises what an error of the reader is in Python: OSError, MemoryError, or acdf.FileError.
[[noreturn]] void raise(const AcdfError& error);

} // namespace acdf::python
