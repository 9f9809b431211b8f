// The table of functions, and the tree of an open file.
#include <acdf/curves/curves.h>

#include "curves/functions.h"
#include "opened_file.h"

const AcdfCurves* acdf_curves() {
    static const AcdfCurves functions = {
        acdf::inflate_planes,          acdf::check_curves,      acdf::curves_sample,     acdf::curves_pdf,
        acdf::curves_invert,           acdf::curves_find,       acdf::curves_local_bins, acdf::curves_local_at,
        acdf::curves_local_irradiance, acdf::curves_brdf_view,  acdf::curves_brdf_find,  acdf::curves_brdf_sample,
        acdf::curves_brdf_pdf,         acdf::curves_brdf_invert};
    return &functions;
}

const uint8_t* acdf_curves_tree(const AcdfFile* file, uint32_t* units) {
    const acdf::Payload& tree = file->payloads.of[acdf::chunk_tree];
    *units = static_cast<uint32_t>(tree.size / 2);
    return tree.data;
}
