#include "tools/cli/mis_text.h"

#include <cstdio>

namespace acdf::tools {

bool parse_shares(const std::string& text, builder::Partner& partner) {
    int end = 0;
    double light = 0.0, other = 0.0;
    if (std::sscanf(text.c_str(), "%lf:%lf%n", &light, &other, &end) != 2 ||
        static_cast<std::size_t>(end) != text.size())
        return false;
    for (const double share : {light, other})
        if (!(share >= 1e-3 && share <= 1e3)) return false;
    partner.light = light;
    partner.other = other;
    return true;
}

bool parse_partner(const std::string& text, builder::Partner& partner) {
    if (text == "none") partner.kind = ACDF_PARTNER_NONE;
    else if (text == "cosine") partner.kind = ACDF_PARTNER_COSINE;
    else if (text == "brdf") partner.kind = ACDF_PARTNER_BRDF;
    else if (text == "mean") partner.kind = ACDF_PARTNER_MEAN;
    else return false;
    return true;
}

bool parse_heuristic(const std::string& text, builder::Partner& partner) {
    if (text != "balance" && text != "power") return false;
    partner.heuristic = text == "power" ? ACDF_HEURISTIC_POWER : ACDF_HEURISTIC_BALANCE;
    return true;
}

} // namespace acdf::tools
