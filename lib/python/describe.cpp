// What is inside a file, as plain Python values; names as in `acdf info --json`.
#include "build/text/format_names.h"
#include "build/text/partner.h"
#include "python/file.h"

#include <cstring>

namespace acdf::python {
namespace {

py::str text_of(AcdfText text) { return py::str(text.data, text.size); }

py::list axes_of(const AcdfFile* file) {
    py::list out;
    for (std::uint32_t i = 0; const AcdfAxis* axis = acdf_axis(file, i); ++i) {
        const char* name = reinterpret_cast<const char*>(axis->name);
        py::dict one;
        one["name"] = py::str(name, strnlen(name, sizeof axis->name));
        one["role"] = build::role_name(axis->role);
        one["measure"] = build::measure_name(axis->measure);
        one["resolution"] = axis->resolution;
        one["low"] = axis->low;
        one["high"] = axis->high;
        out.append(one);
    }
    return out;
}

py::list chunks_of(const AcdfFile* file) {
    py::list out;
    const AcdfHeader* header = acdf_header(file);
    const auto* chunks = reinterpret_cast<const AcdfChunk*>(header + 1);
    for (std::uint32_t i = 0; i < header->chunk_count; ++i) {
        py::dict one;
        one["type"] = build::chunk_name(chunks[i].type);
        one["codec"] = build::codec_name(chunks[i].codec);
        one["offset"] = chunks[i].offset;
        one["stored"] = chunks[i].stored_length;
        one["raw"] = chunks[i].raw_length;
        out.append(one);
    }
    return out;
}

py::object partner_of(const AcdfFile* file) {
    const AcdfPartner* partner = nullptr;
    AcdfEnvironment environment;
    AcdfLocal local;
    AcdfTable table;
    if (acdf_environment(file, &environment)) partner = environment.partner;
    if (acdf_local(file, &local)) partner = local.partner;
    if (acdf_table(file, &table)) partner = table.partner;
    if (!partner) return py::none();
    py::dict out;
    out["kind"] = build::partner_name(static_cast<AcdfPartnerKind>(partner->kind));
    out["heuristic"] = build::heuristic_name(static_cast<AcdfHeuristic>(partner->heuristic));
    out["share"] = partner->share;
    out["recommended_light_share"] = partner->recommended_light_share;
    return std::move(out);
}

py::dict metadata_of(const AcdfFile* file) {
    py::dict out;
    AcdfText key, value;
    for (std::uint32_t i = 0; acdf_metadata_pair(file, i, &key, &value); ++i) out[text_of(key)] = text_of(value);
    return out;
}

/// What a file takes in memory: its bytes, what was inflated of them, and the tables made at load.
std::uint64_t memory_of(const AcdfFile* file) {
    AcdfMove parts[ACDF_MAX_MOVES];
    std::uint64_t sum = 0;
    for (int i = acdf_memory(file, parts); i-- > 0;) sum += parts[i].bytes;
    return sum;
}

py::dict description_of(const OpenFile& open) {
    const AcdfFile* file = open.file();
    const AcdfHeader* header = acdf_header(file);
    const AcdfDescription* description = acdf_description(file);
    py::dict out;
    out["kind"] = build::kind_name(header->kind);
    out["version"] = std::to_string(header->version_major) + "." + std::to_string(header->version_minor);
    out["bytes"] = acdf_size(file);
    const std::uint64_t of_maps = open.maps().tables.bytes;
    out["table_bytes"] = acdf_table_bytes(file) + of_maps;
    out["memory_bytes"] = memory_of(file) + of_maps;
    out["bins"] = description->bin_count;
    out["partner"] = partner_of(file);
    out["axes"] = axes_of(file);
    out["fit"] = build::fit_name(description->fit);
    out["filter"] = build::filter_name(description->filter);
    out["parameterization"] = build::parameterization_name(description->parameterization);
    py::list weights;
    for (const auto weight : description->channel_weights) weights.append(weight);
    out["channel_weights"] = weights;
    out["total"] = description->total;
    out["chunks"] = chunks_of(file);
    out["metadata"] = metadata_of(file);
    return out;
}

} // namespace

void add_file(py::module_& module) {
    py::class_<OpenFile>(module, "OpenFile")
        .def("describe", &description_of)
        .def("sample", &OpenFile::sample)
        .def("pdf", &OpenFile::pdf)
        .def("invert", &OpenFile::invert)
        .def("total_of", &OpenFile::total_of)
        .def("to_bytes", [](const OpenFile& open) {
            return py::bytes(reinterpret_cast<const char*>(acdf_header(open.file())), acdf_size(open.file()));
        });
    module.def("open_path", &OpenFile::from_path);
    module.def("open_bytes", &OpenFile::from_bytes);
}

} // namespace acdf::python
