#include "build/text/partner.h"

#include "build/text/options.h"

namespace acdf::build {

const char* partner_name(AcdfPartnerKind kind) {
    switch (kind) {
    case ACDF_PARTNER_COSINE:
        return "cosine";
    case ACDF_PARTNER_BRDF:
        return "brdf";
    case ACDF_PARTNER_MEAN:
        return "mean";
    case ACDF_PARTNER_TABLE:
        return "table";
    default:
        return "none";
    }
}

const char* heuristic_name(AcdfHeuristic heuristic) {
    return heuristic == ACDF_HEURISTIC_POWER ? "power" : "balance";
}

std::string partner_text(const compress::Partner& partner) {
    if (!partner) return {};
    std::string text = std::string("--mis ") + partner_name(partner.kind) + " ";
    if (partner.light != partner.other)
        text += "--shares " + option_number(partner.light) + ":" + option_number(partner.other) + " ";
    if (partner.heuristic != ACDF_HEURISTIC_BALANCE)
        text += std::string("--heuristic ") + heuristic_name(partner.heuristic) + " ";
    return text;
}

} // namespace acdf::build
