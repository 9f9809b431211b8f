#include "build/text/company.h"

#include "build/text/options.h"

namespace acdf::build {

const char* company_name(AcdfCompanyKind kind) {
    switch (kind) {
    case ACDF_COMPANY_COSINE:
        return "cosine";
    case ACDF_COMPANY_BRDF:
        return "brdf";
    case ACDF_COMPANY_MEAN:
        return "mean";
    case ACDF_COMPANY_TABLE:
        return "table";
    default:
        return "none";
    }
}

const char* heuristic_name(AcdfHeuristic heuristic) {
    return heuristic == ACDF_HEURISTIC_POWER ? "power" : "balance";
}

std::string company_text(const compress::Company& company) {
    if (!company) return {};
    std::string text = std::string("--with ") + company_name(company.kind) + " ";
    if (company.light != company.other)
        text += "--shares " + option_number(company.light) + ":" + option_number(company.other) + " ";
    if (company.heuristic != ACDF_HEURISTIC_BALANCE)
        text += std::string("--heuristic ") + heuristic_name(company.heuristic) + " ";
    return text;
}

} // namespace acdf::build
