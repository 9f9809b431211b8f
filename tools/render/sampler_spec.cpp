#include "tools/render/sampler_spec.h"

#include "tools/cli/mis_text.h"
#include "tools/cli/sizes.h"

#include <acdf/product/cut.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <sstream>

namespace acdf::tools {
namespace {

constexpr std::size_t kMostParts = 8, kMostText = 4096;
constexpr std::uint32_t kMostCells = 4096, kMostCandidates = 65536;

[[noreturn]] void fail(const std::string& text, const std::string& what) {
    throw SpecError("sampler '" + text + "': " + what);
}

struct Name {
    const char* name;
    SamplerKind kind;
    const char* argument; ///< what its default is, or null: it takes none
};

constexpr Name names[] = {
    {"full-cdf", SamplerKind::full_cdf, nullptr},
    {"cosine", SamplerKind::cosine, nullptr},
    {"tiles", SamplerKind::tiles, "32x16"},
    {"visibility-cache", SamplerKind::visibility_cache, "32x16"},
    {"portals", SamplerKind::portals, "light"},
    {"env", SamplerKind::env, "64KiB"},
    {"local", SamplerKind::local, "1MiB"},
    {"visibility", SamplerKind::visibility, "4MiB"},
    {"visibility-portals", SamplerKind::visibility_portals, "4MiB"},
    {"learned", SamplerKind::learned, "4MiB"},
    {"brdf", SamplerKind::brdf, "128KiB"},
    {"brdf-table", SamplerKind::brdf_table, "mean"},
    {"ggx", SamplerKind::ggx, "0.1"},
    {"alias", SamplerKind::alias, nullptr},
    {"hierarchical", SamplerKind::hierarchical, nullptr},
    {"downsampled", SamplerKind::downsampled, "64x32"},
    {"compensated", SamplerKind::compensated, nullptr},
    {"strata", SamplerKind::strata, "solid-angle"},
    {"ris", SamplerKind::ris, "32"},
    {"product", SamplerKind::product, "auto"},
    {"warp", SamplerKind::warp, nullptr},
    {"ideal", SamplerKind::ideal, nullptr},
    {"file", SamplerKind::file, ""},
};

/// A whole text as a number.
bool parse_number(const std::string& text, double& value) {
    int end = 0;
    return !text.empty() && std::sscanf(text.c_str(), "%lf%n", &value, &end) == 1 &&
           static_cast<std::size_t>(end) == text.size() && std::isfinite(value) &&
           !std::isspace(static_cast<unsigned char>(text.front()));
}

void read_size(const std::string& argument, SamplerSpec& spec) {
    const auto bytes = parse_size(argument);
    if (!bytes || *bytes == 0) fail(spec.text, "'" + argument + "' is not a size, such as 64KiB");
    spec.bytes = *bytes;
}

void read_grid(const std::string& argument, SamplerSpec& spec) {
    if (!parse_pair(argument, kMostCells, spec.columns, spec.rows))
        fail(spec.text, "'" + argument + "' is not a grid, such as 32x16");
}

void read_argument(const std::string& argument, SamplerSpec& spec) {
    double number = 0.0;
    switch (spec.kind) {
    case SamplerKind::env:
    case SamplerKind::local:
    case SamplerKind::visibility:
    case SamplerKind::visibility_portals:
    case SamplerKind::learned:
    case SamplerKind::brdf:
        return read_size(argument, spec);
    case SamplerKind::tiles:
    case SamplerKind::visibility_cache:
    case SamplerKind::downsampled:
        return read_grid(argument, spec);
    case SamplerKind::portals:
        spec.uniform = argument == "uniform";
        if (!spec.uniform && argument != "light") fail(spec.text, "give portals or portals:uniform");
        return;
    case SamplerKind::brdf_table:
        spec.centre = argument == "centre";
        if (!spec.centre && argument != "mean") fail(spec.text, "give brdf-table:mean or brdf-table:centre");
        return;
    case SamplerKind::strata:
        spec.by_radiance = argument == "radiance";
        if (!spec.by_radiance && argument != "solid-angle") fail(spec.text, "give strata or strata:radiance");
        return;
    case SamplerKind::ggx:
        if (!parse_number(argument, spec.alpha) || spec.alpha < 0.001 || spec.alpha > 2.0)
            fail(spec.text, "alpha is a number from 0.001 to 2");
        return;
    case SamplerKind::ris:
        if (!parse_number(argument, number) || number != std::floor(number) || number < 1.0 ||
            number > kMostCandidates)
            fail(spec.text, "the number of candidates is from 1 to " + std::to_string(kMostCandidates));
        spec.candidates = static_cast<std::uint32_t>(number);
        return;
    case SamplerKind::product:
        if (argument == "auto") return;
        if (!parse_number(argument, number) || number != std::floor(number) || number < 1.0 ||
            number > double{ACDF_CUT_MAX_PARTS})
            fail(spec.text, "the number of parts is from 1 to " + std::to_string(ACDF_CUT_MAX_PARTS));
        spec.divisions = static_cast<std::uint32_t>(number);
        return;
    case SamplerKind::file:
        if (argument.empty()) fail(spec.text, "needs a file, file:my.acdf");
        spec.path = argument;
        return;
    default:
        return;
    }
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Visibility cells, which are valid alone whatever they are made for.
bool has_cells(SamplerKind kind) {
    return kind == SamplerKind::learned || kind == SamplerKind::visibility ||
           kind == SamplerKind::visibility_portals;
}

/// " --mis cosine --shares 2:1 --heuristic power --scene".
void read_partner(const std::string& options, SamplerSpec& spec) {
    if (spec.kind != SamplerKind::env && spec.kind != SamplerKind::local && !has_cells(spec.kind) &&
        spec.kind != SamplerKind::ideal)
        fail(spec.text, "takes no options: env, local, visibility, learned and ideal do");
    std::vector<std::string> words;
    std::istringstream stream(options);
    for (std::string word; stream >> word;) words.push_back(word);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--scene" && spec.kind != SamplerKind::ideal) {
            spec.of_scene = true;
            continue;
        }
        const std::string value = i + 1 < words.size() ? words[i + 1] : "";
        const bool known = words[i] == "--mis"         ? parse_partner(value, spec.mis)
                           : words[i] == "--shares"    ? parse_shares(value, spec.mis)
                           : words[i] == "--heuristic" ? parse_heuristic(value, spec.mis)
                                                       : false;
        if (!known)
            fail(spec.text, "'" + words[i] + " " + value + "' is not an option: --mis cosine, --shares 2:1, " +
                                "--heuristic power or --scene");
        ++i;
    }
    const builder::Partner& mis = spec.mis;
    if (has_cells(spec.kind) && (mis.kind > ACDF_PARTNER_COSINE || mis.heuristic != ACDF_HEURISTIC_BALANCE ||
                                 mis.light != mis.other || spec.of_scene))
        fail(spec.text, "takes --mis cosine alone");
    if ((spec.kind == SamplerKind::ideal || spec.kind == SamplerKind::local) && spec.mis.kind > ACDF_PARTNER_COSINE)
        fail(spec.text, "takes --mis cosine alone");
}

SamplerSpec parse_single(const std::string& whole) {
    const std::string text = trimmed(whole);
    const std::size_t option = text.compare(0, 5, "file:") == 0 ? std::string::npos : text.find(" --");
    const std::string plain = text.substr(0, option);
    const std::size_t colon = plain.find(':');
    const std::string name = plain.substr(0, colon);
    const auto* found =
        std::find_if(std::begin(names), std::end(names), [&](const Name& n) { return name == n.name; });
    if (found == std::end(names)) {
        std::string all;
        for (const Name& n : names) all += std::string(n.name) + ", ";
        fail(text, "is none of " + all + "mis(...), mis-power(...), mis-compensated");
    }
    SamplerSpec spec;
    spec.kind = found->kind;
    spec.text = text;
    if (colon != std::string::npos && !found->argument) fail(text, "takes no argument");
    if (found->argument)
        read_argument(colon == std::string::npos ? found->argument : plain.substr(colon + 1), spec);
    if (option != std::string::npos) read_partner(text.substr(option), spec);
    return spec;
}

/// The texts between commas that are in no parentheses.
std::vector<std::string> split(const std::string& whole, const std::string& inside) {
    std::vector<std::string> out(1);
    int open = 0;
    for (const char c : inside) {
        open += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (open < 0) fail(whole, "has a ')' too many");
        if (c == ',' && open == 0) out.emplace_back();
        else out.back() += c;
    }
    if (open != 0) fail(whole, "has a '(' too many");
    return out;
}

bool is_brdf(const SamplerSpec& spec) {
    return spec.kind == SamplerKind::brdf || spec.kind == SamplerKind::ggx || spec.kind == SamplerKind::file;
}

/// What is made of other samplers but mis: NAME[:ARGUMENT](PART,...).
SamplerSpec parse_made(const std::string& text, std::size_t open) {
    SamplerSpec spec = parse_single(text.substr(0, open));
    spec.text = text;
    for (const std::string& part : split(text, text.substr(open + 1, text.size() - open - 2)))
        spec.parts.push_back(parse_single(part));
    for (const SamplerSpec& part : spec.parts)
        if (part.mis.kind != ACDF_PARTNER_NONE)
            fail(text, "'" + part.text + "' has a pdf of 0 where its MIS partner suffices");
    const std::size_t count = spec.parts.size();
    const SamplerSpec &first = spec.parts.front(), &last = spec.parts.back();
    switch (spec.kind) {
    case SamplerKind::product:
        if (count != 2 || !is_brdf(last) ||
            (first.kind != SamplerKind::local && first.kind != SamplerKind::visibility &&
             first.kind != SamplerKind::env && first.kind != SamplerKind::file))
            fail(text, "give product(LIGHT,BRDF): LIGHT is local:SIZE, visibility:SIZE, env:SIZE or a file; BRDF "
                       "is brdf:SIZE, ggx:ALPHA or a file");
        return spec;
    case SamplerKind::warp:
        if (count != 2 || !is_brdf(last) ||
            (first.kind != SamplerKind::local && first.kind != SamplerKind::env && first.kind != SamplerKind::file))
            fail(text, "give warp(LIGHT,BRDF): LIGHT is local:SIZE, env:SIZE or a file; BRDF is brdf:SIZE, "
                       "ggx:ALPHA or a file");
        return spec;
    case SamplerKind::tiles:
        if (count != 1 || !is_brdf(last))
            fail(text, "give tiles:12x12(BRDF): BRDF is brdf:SIZE, ggx:ALPHA or a file");
        return spec;
    case SamplerKind::ris:
        if (count != 2) fail(text, "takes its candidates from two samplers");
        for (const SamplerSpec& part : spec.parts)
            if (part.kind == SamplerKind::ris || part.kind == SamplerKind::strata ||
                part.kind == SamplerKind::product || part.kind == SamplerKind::warp)
                fail(text, "'" + part.text + "' cannot give candidates");
        return spec;
    default:
        fail(text, "takes no samplers in parentheses: product(...), warp(...), tiles:12x12(...), ris:32(...) and "
                   "mis(...) do");
    }
}

/// One that is no mis(...).
SamplerSpec parse_part(const std::string& text) {
    const std::size_t open = text.find('(');
    if (open == std::string::npos || text.back() != ')' || text.compare(0, 5, "file:") == 0) {
        SamplerSpec spec = parse_single(text);
        if (spec.kind == SamplerKind::product) fail(text, "give product(LIGHT,BRDF)");
        if (spec.kind == SamplerKind::warp) fail(text, "give warp(LIGHT,BRDF)");
        return spec;
    }
    return parse_made(text, open);
}

SamplerSpec parse_mis(const std::string& text, std::size_t begin) {
    SamplerSpec spec;
    spec.kind = SamplerKind::mis;
    spec.text = text;
    spec.power = text.compare(0, 9, "mis-power") == 0;
    for (const std::string& part : split(text, text.substr(begin, text.size() - begin - 1))) {
        const std::size_t star = part.find('*');
        double share = 1.0;
        const bool weighted = star != std::string::npos && parse_number(part.substr(0, star), share);
        if (!(share >= 1e-6 && share <= 1e6)) fail(text, "shares are from 1e-6 to 1e6");
        std::string one = trimmed(weighted ? part.substr(star + 1) : part);
        const bool automatic = one.compare(0, 5, "auto:") == 0;
        if (automatic) one = one.substr(5);
        spec.parts.push_back(parse_part(one));
        spec.parts.back().automatic = automatic;
        const SamplerSpec& last = spec.parts.back();
        if (last.kind == SamplerKind::ris || last.kind == SamplerKind::strata)
            fail(text, "'" + last.text + "' has no pdf, which MIS needs");
        spec.shares.push_back(share);
    }
    if (spec.parts.size() < 2 || spec.parts.size() > kMostParts)
        fail(text, "combines from 2 to " + std::to_string(kMostParts) + " samplers");
    if (std::count_if(spec.parts.begin(), spec.parts.end(), [](const SamplerSpec& p) { return p.automatic; }) > 1)
        fail(text, "one part at most is auto:");
    const double sum = std::accumulate(spec.shares.begin(), spec.shares.end(), 0.0);
    for (double& share : spec.shares) share /= sum;
    return spec;
}

} // namespace

SamplerSpec parse_sampler(const std::string& text) {
    if (text.size() > kMostText) fail(text.substr(0, 40), "is longer than " + std::to_string(kMostText) + " bytes");
    for (const std::string prefix : {"mis(", "mis-power("})
        if (text.compare(0, prefix.size(), prefix) == 0 && text.back() == ')')
            return parse_mis(text, prefix.size());
    if (text == "mis-compensated") {
        SamplerSpec spec = parse_sampler("mis(compensated,cosine)");
        spec.text = text;
        return spec;
    }
    SamplerSpec spec = parse_part(text);
    if (spec.kind == SamplerKind::compensated)
        fail(text,
             "its pdf is 0 where there is little light; use mis-compensated, which is mis(compensated,cosine)");
    if (spec.mis.kind != ACDF_PARTNER_NONE && !has_cells(spec.kind))
        fail(text, "its pdf is 0 where the MIS partner suffices; use mis(" + text + ", cosine)");
    return spec;
}

std::string file_stem(const SamplerSpec& spec) {
    std::string out;
    for (const char c : spec.text) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (plain || c == '.') out += plain ? c : '_';
        else if (!out.empty() && out.back() != '-') out += '-';
    }
    while (!out.empty() && out.back() == '-') out.pop_back();
    return out.substr(0, 80);
}

std::vector<std::uint32_t> divided(std::uint32_t samples, const SamplerSpec& spec) {
    const std::size_t parts = spec.shares.size();
    if (samples < parts) fail(spec.text, "needs at least " + std::to_string(parts) + " samples");
    std::vector<std::uint32_t> out(parts, 1);
    const auto given = [&] { return std::accumulate(out.begin(), out.end(), std::uint32_t{0}); };
    for (std::size_t i = 0; i < parts; ++i)
        out[i] = std::max(1u, static_cast<std::uint32_t>(std::floor(spec.shares[i] * samples)));
    const auto lacking = [&](std::size_t i) { return spec.shares[i] * samples - out[i]; };
    while (given() != samples) {
        const bool more = given() < samples;
        std::size_t best = parts;
        for (std::size_t i = 0; i < parts; ++i) {
            if (!more && out[i] == 1) continue;
            if (best == parts || (more ? lacking(i) > lacking(best) : lacking(i) < lacking(best))) best = i;
        }
        out[best] += more ? 1u : -1u;
    }
    return out;
}

} // namespace acdf::tools
