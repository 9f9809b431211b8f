#include "tools/cli/renderer.h"

#include "build/text/partner.h"

#include <CLI/CLI.hpp>

namespace acdf::tools {
namespace {

std::string renderer_names() {
    std::string out;
    for (const builder::Renderer& renderer : builder::renderers())
        out += (out.empty() ? "" : ", ") + std::string(renderer.name);
    return out;
}

} // namespace

void add_renderer(CLI::App& command, const builder::Renderer*& chosen) {
    command
        .add_option_function<std::string>(
            "--for",
            [&chosen](const std::string& name) {
                chosen = builder::find_renderer(name.c_str());
                if (!chosen)
                    throw CLI::ValidationError("--for", "'" + name + "' is none of " + renderer_names() +
                                                            "; docs/conventions.md says what is known of others");
            },
            "The renderer that will use the file. It sets --domain, --filter, --wrap and --channel to how the "
            "renderer looks its map up, and --mis and --heuristic to how its path integrator combines samples. "
            "Options that you give yourself take precedence. The command prints which axes to swap. The "
            "renderers: " +
                renderer_names())
        ->option_text("NAME")
        ->group("Input");
}

void use_renderer(const CLI::App& command, const builder::Renderer* chosen, input::ProbeOptions& input,
                  builder::TargetOptions& target) {
    if (!chosen) return;
    const auto given = [&](const char* option) { return command.get_option(option)->count() > 0; };
    if (!given("--domain")) input.domain = chosen->target.domain;
    input.squares_are_octahedral = chosen->target.domain == input::Domain::octahedral;
    if (!given("--filter")) target.filter = chosen->target.filter;
    if (!given("--wrap")) target.wrap = chosen->target.wrap;
    if (!given("--channel")) target.channels = chosen->target.channels;
}

bool use_partner(const CLI::App& command, const builder::Partner& suits, builder::Partner& partner) {
    if (suits.kind == ACDF_PARTNER_NONE) return false;
    if (command.get_option("--heuristic")->count() == 0) partner.heuristic = suits.heuristic;
    if (command.get_option("--mis")->count() > 0) return false;
    partner.kind = suits.kind;
    return true;
}

std::string partner_text(const builder::Renderer& renderer, const builder::Partner& partner) {
    std::string options = build::partner_text({partner.kind, partner.heuristic, partner.light, partner.other});
    options.pop_back();
    return std::string("made to be combined with BSDF samples, as ") + renderer.name + "'s path integrator does (" +
           options + "): never use it alone; for an integrator that takes light samples alone add --mis none";
}

std::string axes_text(const builder::Renderer& renderer, builder::Projection projection) {
    const builder::Axes* axes = renderer.axes_of(projection);
    const std::string name = renderer.name;
    const builder::Axes& to = axes ? *axes : renderer.axes;
    const std::string text = "in " + name + " a sample's (x, y, z) is " + to.text() +
                             " in the frame of the light; evaluate the pdf of its (X, Y, Z) at " +
                             to.inverse().text("XYZ");
    if (axes) return text;
    const char* own = renderer.target.domain == builder::Domain::octahedral ? "octahedral" : "lat-long";
    return text + ", once this map is made into the " + own + " one that it looks up";
}

} // namespace acdf::tools
