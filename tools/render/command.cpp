// acdf render: direct lighting of a scene with several samplers.
#include "tools/cli/comma_list.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/plot/image.h"
#include "tools/render/images.h"
#include "tools/render/output_files.h"
#include "tools/render/page.h"
#include "tools/render/report.h"
#include "tools/render/run.h"
#include "tools/render/sampler_build.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

namespace acdf::tools {
namespace {

struct RenderArguments {
    std::string scene, output, data = ".", size;
    std::vector<std::string> samplers, at;
    std::uint32_t samples = 0, seeds = 0; ///< 0: the scene's
    ComparisonOptions comparison;
    std::vector<measure::Numbers> sequences{measure::Numbers::independent, measure::Numbers::sobol};
    int threads = 0;
    bool no_reference = false, no_timing = false, images = false, json = false, quiet = false, force = false;
};

/// Calls `make`; its errors get the scene's name as a prefix.
template <typename Make>
auto of_scene(const RenderArguments& options, const Make& make) {
    try {
        return make();
    } catch (const SceneError& error) {
        throw Failure(options.scene + ": " + error.what());
    }
}

SceneFile read_scene(const RenderArguments& options) {
    const std::vector<std::uint8_t> bytes = read_bytes(options.scene, kMostSceneBytes);
    return of_scene(options, [&] { return parse_scene({bytes.begin(), bytes.end()}); });
}

void apply_options(const RenderArguments& options, SceneFile& scene) {
    if (!options.samplers.empty()) scene.samplers = options.samplers;
    if (options.samples > 0) scene.samples = options.samples;
    if (options.seeds > 0) scene.seeds = options.seeds;
    if (!options.size.empty() && !parse_pair(options.size, 4096, scene.width, scene.height))
        throw CLI::ValidationError("--size", "needs two counts such as 96x72");
}

std::vector<SamplerSpec> specs(const RenderArguments& options, const SceneFile& scene) {
    std::vector<SamplerSpec> out;
    for (const std::string& text : scene.samplers) {
        try {
            out.push_back(parse_sampler(text));
        } catch (const SpecError& error) {
            if (!options.samplers.empty()) throw CLI::ValidationError("--sampler", error.what());
            throw SceneError(std::string("samplers: ") + error.what());
        }
    }
    return out;
}

/// Files of a folder, each written whole or not at all.
class Folder {
public:
    Folder(std::string path, bool force) : path_(std::move(path)), force_(force) {}

    void write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
        write_output(at(name), bytes, force_);
    }
    std::string at(const std::string& name) const { return (std::filesystem::path(path_) / name).string(); }

private:
    std::string path_;
    bool force_;
};

/// Makes all pictures; writes each as files, too, where that is asked for.
class Pictures {
public:
    Pictures(const Folder* folder, const LoadedScene& scene, const RenderRun& run)
        : folder_(folder), scene_(scene), run_(run), exposure_(exposure(run.passes.front().comparison.reference)) {}

    PagePictures all(const std::vector<std::string>& stems) const {
        const Comparison& comparison = run_.passes.front().comparison;
        PagePictures out;
        out.width = static_cast<int>(scene_.scene.width);
        out.height = static_cast<int>(scene_.scene.height);
        out.reference = picture("reference", comparison.reference, "reference");
        const std::vector<Compared>& samplers = comparison.samplers;
        std::vector<double> variances;
        for (const Compared& one : samplers)
            variances.insert(variances.end(), one.relative_variance_of_points.begin(),
                             one.relative_variance_of_points.end());
        const PdfRange range = figure_range(variances);
        for (std::size_t i = 0; i < samplers.size(); ++i) {
            const std::string& name = samplers[i].spec.text;
            SamplerPictures of;
            of.picture = picture(stems[i], samplers[i].rendering.first, name);
            of.variance = figure(stems[i] + "-variance", samplers[i].relative_variance_of_points,
                                 {"relative variance, " + name, range, ColourMap::rainbow, true});
            of.above = figure(stems[i] + "-above", samplers[i].rendering.share_above,
                              {"share above the horizon, " + name, {0.01, 1.0}, ColourMap::rainbow, true});
            if (i > 0) of.gain = gain(stems[i] + "-gain", samplers[i], samplers.front());
            out.samplers.push_back(std::move(of));
        }
        return out;
    }

private:
    using Png = std::vector<std::uint8_t>;

    Png picture(const std::string& stem, const std::vector<measure::Rgb>& values, const std::string& what) const {
        const images::Picture linear = scene_picture(scene_.scene, scene_.points, values);
        if (folder_) folder_->write(stem + ".exr", encode_rgb_exr(linear, notes(what)));
        return kept(stem, encode_png(displayed(linear, exposure_), notes(what)));
    }
    Png figure(const std::string& name, const std::vector<double>& values, const FigureImage& figure) const {
        return kept(name,
                    encode_png(figure_picture(scene_.scene, scene_.points, values, figure), notes(figure.title)));
    }
    /// Ratio of variances: above 1 the sampler is better than the baseline.
    Png gain(const std::string& name, const Compared& one, const Compared& base) const {
        std::vector<double> gain;
        for (std::size_t i = 0; i < one.rendering.variance.size(); ++i) {
            const double a = base.rendering.variance[i], b = one.rendering.variance[i];
            gain.push_back(a == b ? 1.0 : std::clamp(a / b, 1e-3, 1e3));
        }
        const PdfRange ends = figure_range(gain);
        const double most = std::max({ends.high, 1.0 / ends.low, 8.0});
        return figure(name, gain,
                      {"gain: variance of " + base.spec.text + " over that of " + one.spec.text,
                       {1.0 / most, most},
                       ColourMap::diverging,
                       false});
    }
    Png kept(const std::string& name, Png png) const {
        if (folder_) folder_->write(name + ".png", png);
        return png;
    }
    ImageNotes notes(const std::string& what) const { return {"acdf " ACDF_VERSION, what}; }

    const Folder* folder_; ///< null: the page has them alone
    const LoadedScene& scene_;
    const RenderRun& run_;
    double exposure_;
};

std::vector<const input::Brdf*> brdfs_of(const LoadedScene& scene) {
    std::vector<const input::Brdf*> out;
    for (const auto& brdf : scene.brdfs) out.push_back(brdf.get());
    return out;
}

builder::Target light_target(const RenderArguments& options, const input::Probe& probe, AcdfFilter filter) {
    builder::Pixels pixels;
    pixels.data = probe.rgb.data();
    pixels.width = static_cast<std::uint32_t>(probe.width);
    pixels.height = static_cast<std::uint32_t>(probe.height);
    builder::TargetOptions how;
    how.filter = filter;
    builder::Target target;
    const builder::Status status = builder::Target::from(pixels, how, target);
    if (status.code == builder::ErrorCode::no_energy)
        throw Failure(options.scene + ": light: the probe is black, so there is nothing to sample");
    if (!status.ok()) throw Failure(options.scene + ": light: " + status.message);
    return target;
}

RenderRun render_all(const RenderArguments& options, const LoadedScene& scene, std::vector<SamplerSpec> samplers) {
    RenderRun run;
    run.scene = std::filesystem::path(options.scene).filename().string();
    run.options = options.comparison;
    run.options.samplers = std::move(samplers);
    run.options.samples = scene.file.samples;
    if (scene.file.seeds > 0) run.options.render.seeds = scene.file.seeds;
    run.options.reference = !options.no_reference && scene.file.reference;
    run.options.timing = !options.no_timing;
    const builder::Target target = light_target(options, scene.probe, scene.file.filter);
    std::vector<builder::SceneNormal> normals;
    for (const measure::ScenePoint& point : scene.points.points) {
        const float* n = point.shading().n;
        normals.push_back({{n[0], n[1], n[2]}, 1.0});
    }
    SamplerBuilder builder(target, brdfs_of(scene), options.data, std::move(normals), &scene.scene.geometry,
                           &scene.points.points, options.at);
    bool occluders = false;
    for (const measure::Object& object : scene.scene.geometry.objects) occluders |= !object.seen;
    std::vector<measure::ScenePoint> open;
    for (const measure::ScenePoint& point : scene.points.points)
        if (occluders) open.push_back(point.in_the_open());
    ProgressBar bar(options.quiet);
    const build::Progress progress = bar.callback();
    for (const measure::Numbers numbers : options.sequences) {
        run.options.render.numbers = numbers;
        // References are the same whatever the numbers.
        const RenderPass* first = run.passes.empty() || !run.options.reference ? nullptr : &run.passes.front();
        RenderPass pass;
        pass.numbers = numbers;
        pass.comparison = compare(scene.scene, scene.points.points, builder, run.options, progress,
                                  first ? first->comparison.reference : std::vector<measure::Rgb>());
        if (occluders)
            pass.in_the_open = compare(scene.scene, open, builder, run.options, progress,
                                       first ? first->in_the_open->reference : std::vector<measure::Rgb>());
        run.passes.push_back(std::move(pass));
    }
    return run;
}

void remark(const RenderArguments& options, const LoadedScene& scene) {
    if (options.quiet) return;
    for (const std::string& warning : scene.probe.warnings) say(scene.file.probe + ": " + warning);
    for (std::size_t i = 0; i < scene.brdfs.size(); ++i)
        for (const std::string& note : scene.brdfs[i]->notes) say(scene.file.materials[i].brdf + ": " + note);
}

/// All files that are read.
std::vector<std::string> inputs(const RenderArguments& options, const SceneFile& scene,
                                const std::vector<SamplerSpec>& samplers) {
    std::vector<std::string> out = files_of(samplers, options.data);
    out.push_back(options.scene);
    const auto add = [&](const std::string& name) {
        out.push_back((std::filesystem::path(options.data) / name).string());
    };
    add(scene.probe);
    for (const SceneMaterial& material : scene.materials) add(material.brdf);
    for (const SceneMesh& mesh : scene.meshes) add(mesh.file);
    return out;
}

void run(const RenderArguments& options) {
    const auto limit = limit_threads(options.threads);
    SceneFile file = read_scene(options);
    apply_options(options, file);
    std::vector<SamplerSpec> samplers = of_scene(options, [&] { return specs(options, file); });
    const Folder folder(options.output, options.force);
    const OutputFolder made(options.output);
    const std::vector<std::string> stems = file_stems(samplers);
    refuse_outputs(options.output, options.images ? stems : std::vector<std::string>(), options.force,
                   inputs(options, file, samplers));

    std::unique_ptr<LoadedScene> scene;
    const RenderRun done = of_scene(options, [&] {
        scene = load_scene(file, options.data);
        remark(options, *scene);
        return render_all(options, *scene, std::move(samplers));
    });
    const PagePictures pictures = Pictures(options.images ? &folder : nullptr, *scene, done).all(stems);
    const std::string json = render_json(*scene, done), page = render_html(*scene, done, pictures);
    folder.write("render.json", {json.begin(), json.end()});
    folder.write("index.html", {page.begin(), page.end()});
    if (options.json) std::fputs(json.c_str(), stdout);
    else put(render_table(*scene, done) + folder.at("index.html") + " shows the pictures\n");
}

void add_measurement_options(CLI::App& command, RenderArguments& options) {
    command
        .add_option("--seeds", options.seeds,
                    "Independent pictures of each sampler: what variances and their confidence come from")
        ->check(CLI::Range(3, 4096))
        ->option_text("N [the scene's, or 16]")
        ->group("Measurement");
    const std::map<std::string, std::vector<measure::Numbers>> sequences{
        {"independent", {measure::Numbers::independent}},
        {"sobol", {measure::Numbers::sobol}},
        {"both", {measure::Numbers::independent, measure::Numbers::sobol}}};
    command
        .add_option_function<std::string>(
            "--sequence",
            [&options, sequences](const std::string& name) { options.sequences = sequences.at(name); },
            "Random numbers: independent ones; sobol, a scrambled Sobol' sequence in each pixel, as renderers "
            "sample "
            "them; or both, one table each")
        ->check(CLI::IsMember({"independent", "sobol", "both"}))
        ->type_name("")
        ->option_text("NAME [both]")
        ->group("Measurement");
    command.add_option("--seed", options.comparison.render.seed, "Of the random numbers")
        ->option_text("N [1]")
        ->group("Measurement");
    command
        .add_flag("--no-reference", options.no_reference,
                  "Compare with the mean of all pictures, not with the exact sum over all texels: faster, blind to "
                  "bias")
        ->group("Measurement");
    command
        .add_flag("--no-timing", options.no_timing,
                  "Leave out equal-time figures: then everything written is the same on each run")
        ->group("Measurement");
    command
        .add_option("--shadow-ray-ns", options.comparison.shadow_ray_ns,
                    "Nanoseconds that a shadow ray costs in your renderer beyond what it does in these simple "
                    "scenes: added in equal-time figures")
        ->check(number_range(0.0, 1e9))
        ->option_text("X [0]")
        ->group("Measurement");
}

void add_scene_options(CLI::App& command, RenderArguments& options) {
    command.add_option("--scene", options.scene, "The scene, as JSON (docs/scene.schema.json)")
        ->required()
        ->type_name("FILE")
        ->group("Input");
    command.add_option("--data", options.data, "The folder that probes and BRDFs are named from")
        ->option_text("DIR [.]")
        ->group("Input");
    command
        .add_option(
            "--sampler", options.samplers,
            "Instead of the scene's; repeat for several, the first is the baseline: full-cdf, cosine, "
            "tiles:32x16, visibility-cache:32x16, portals, portals:uniform, env:64KiB, local:1MB, visibility:4MB, "
            "visibility-portals:4MB, "
            "brdf:64KiB, brdf-table, brdf-table:centre, ggx:0.1, alias, "
            "hierarchical, downsampled:64x32, mis-compensated, strata, ris:32, file:my.acdf, "
            "mis(local:1MB,cosine), mis(4*local,cosine), mis-power(...), product(local:1MB,brdf:64KiB) and "
            "others of docs/render.md")
        ->option_text("TEXT ...")
        ->expected(1)
        ->take_all()
        ->group("Input");
    comma_separated(command.add_option("--at", options.at,
                                       "Of files of several maps (file:day.acdf): where among them, at a map or "
                                       "between; the scene has that map or one for it"))
        ->option_text("NAME=V,...")
        ->group("Input");
    command.add_option("--samples", options.samples, "Samples of each estimate, instead of the scene's")
        ->check(CLI::Range(1, 65536))
        ->option_text("N")
        ->group("Input");
    command.add_option("--size", options.size, "Pixels, instead of the scene's")
        ->option_text("WxH")
        ->group("Input");
}

} // namespace

void add_render(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<RenderArguments>();
    CLI::App& command =
        *program.add_subcommand("render", "Light a simple scene with several samplers, and compare");
    add_scene_options(command, *options);
    add_measurement_options(command, *options);
    command.add_option("-o,--output", options->output, "The folder to write index.html and render.json to")
        ->required()
        ->type_name("DIR")
        ->group("Output");
    command
        .add_flag("--images", options->images,
                  "Also write each picture as .exr and .png, and each map of variance, gain and horizon as .png")
        ->group("Output");
    command.add_flag("-f,--force", options->force, "Replace existing files of the folder")->group("Output");
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help_footer(
        "Writes index.html, one page without network or scripts: the exact picture and one of each sampler beside "
        "it, with zoom and difference, and maps of variance, gain and horizon. render.json has the figures. The "
        "table has the relative variance of an estimate: the mean over pixels with its 95 % confidence interval, "
        "and the median. It also has the noise at 16, 64 and 256 samples, and the gain over the first sampler by "
        "equal samples and by equal time. The table reports where a baseline wins. Where a scene has objects that "
        "the camera does not see, all is measured again without occluders.",
        "acdf render --scene tools/render/scenes/demo.json -o out\n"
        "acdf render --scene tools/render/scenes/e4-grace.json --data ~/probes -o out --size 160x120\n"
        "acdf render --scene my.json -o out --sampler full-cdf --sampler 'mis(local:1MB,cosine)'\n"
        "acdf render --scene my.json -o out --shadow-ray-ns 500 --json"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
