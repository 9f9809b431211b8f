#include "tools/cli/company_text.h"

#include <cstdio>

namespace acdf::tools {

bool parse_shares(const std::string& text, builder::Company& company) {
    int end = 0;
    double light = 0.0, other = 0.0;
    if (std::sscanf(text.c_str(), "%lf:%lf%n", &light, &other, &end) != 2 ||
        static_cast<std::size_t>(end) != text.size())
        return false;
    for (const double share : {light, other})
        if (!(share >= 1e-3 && share <= 1e3)) return false;
    company.light = light;
    company.other = other;
    return true;
}

bool parse_company(const std::string& text, builder::Company& company) {
    if (text == "none") company.kind = ACDF_COMPANY_NONE;
    else if (text == "cosine") company.kind = ACDF_COMPANY_COSINE;
    else if (text == "brdf") company.kind = ACDF_COMPANY_BRDF;
    else if (text == "mean") company.kind = ACDF_COMPANY_MEAN;
    else return false;
    return true;
}

bool parse_heuristic(const std::string& text, builder::Company& company) {
    if (text != "balance" && text != "power") return false;
    company.heuristic = text == "power" ? ACDF_HEURISTIC_POWER : ACDF_HEURISTIC_BALANCE;
    return true;
}

} // namespace acdf::tools
