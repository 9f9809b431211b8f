#include "tools/batch/gallery.h"

#include "tools/batch/source_picture.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/html.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/plot/brdf.h"
#include "tools/plot/colour.h"
#include "tools/plot/image.h"
#include "tools/plot/local.h"

#include <acdf/curves/curves.h>

#include <cstdio>
#include <filesystem>

namespace acdf::tools {
namespace {

constexpr int kMapWidth = 320, kDiscWidth = 160; // both as high

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--page:#f6f7f9;--card:#fff;--ink:#1b1f24;--soft:#59636e;--rule:#d5dae0;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--page:#11151a;--card:#1a2027;--ink:#e8ecf1;--soft:#a2adb9;--rule:#36404b;
--bad:#f2a19b}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1440px;padding:20px;background:var(--page);color:var(--ink);
font:15px/1.45 system-ui,-apple-system,"Segoe UI",sans-serif}
h1{font-size:1.5rem;margin:0}
p{margin:6px 0;color:var(--soft)}
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(460px,100%),1fr));gap:16px;margin-top:16px}
figure{margin:0;padding:10px;background:var(--card);border:1px solid var(--rule);border-radius:8px;min-width:0}
figure div{display:grid;grid-template-columns:1fr 1fr;gap:6px}
img{display:block;width:100%;height:auto;max-height:160px;object-fit:contain}
h2{font-size:1rem;margin:8px 0 0;overflow-wrap:anywhere}
figcaption{font-size:.88rem;color:var(--soft);overflow-wrap:anywhere}
.failed{color:var(--bad)}
)";

/// What the file was made from; empty where that cannot be read any more.
std::string source_thumbnail(const JobResult& job, const BatchJob& planned, const MakeConversion& make) {
    try {
        const std::shared_ptr<Conversion> conversion = make(planned);
        const input::ProbeOptions* reading = conversion->reading();
        const images::Picture picture =
            reading ? probe_picture(job.input, *reading, kMapWidth) : brdf_picture(job.input, kDiscWidth);
        return html_image(encode_png(picture, {"acdf", "the source"}), picture.width, picture.height,
                          "source of " + job.output);
    } catch (const std::exception&) {
        return "";
    }
}

/// A pdf as a small picture; empty where the file cannot be read.
std::string thumbnail(const std::string& path, const std::string& name) {
    File file;
    if (!File::open(path.c_str(), file, with_curves()).ok()) return "";
    PdfImage image;
    std::string shows = "pdf of " + name;
    if (file.kind() == ACDF_KIND_BRDF) {
        image = pdf_image(hemisphere_map(kDiscWidth), pdf_of(PlottedView{file.brdf(), {45.0, 0.0}}));
        shows += " for a view at 45 degrees";
    } else if (file.kind() == ACDF_KIND_LOCAL) {
        image = pdf_image(plot_map(build::Layout::latlong, kMapWidth),
                          pdf_of(PlottedNormal{VisibleLocalView(file.local()), {0.0f, 0.0f, 1.0f}}));
        shows += " for the normal +z";
    } else if (file.kind() == ACDF_KIND_ENVIRONMENT) {
        image = pdf_image(plot_map(build::Layout::latlong, kMapWidth), pdf_of(file.environment()));
    } else if (file.kind() == ACDF_KIND_INDEXED) {
        IndexedEnvironment maps;
        if (!IndexedEnvironment::open(file, maps).ok()) return "";
        image = pdf_image(plot_map(build::Layout::latlong, kMapWidth), pdf_of(first_environment(maps)));
        shows += ", its first map";
    } else {
        return "";
    }
    const PdfRange range = automatic_range(image);
    return html_image(encode_png(false_colour(image, range), {"acdf", "pdf in false colours"}), image.map.width,
                      image.map.height, shows + ", " + to_string(range) + " per steradian");
}

std::string caption(const JobResult& job) {
    char variance[48];
    std::snprintf(variance, sizeof variance, "relative variance %.3g", job.relative_variance);
    return job.kind + ", " + to_readable_size(job.bytes) + ", " + variance + "; noise " +
           noise_texts(job.relative_variance) + " at 16, 64, 256 samples";
}

std::string figure(const JobResult& job, const BatchJob& planned, const std::string& folder,
                   const MakeConversion& make) {
    std::string out = "<figure>\n";
    const bool failed = job.status == JobResult::Status::failed;
    if (!failed)
        out += "<div>" + source_thumbnail(job, planned, make) +
               thumbnail((std::filesystem::path(folder) / job.output).string(), job.output) + "</div>\n";
    out += "<h2><bdi>" + escaped(job.output) + "</bdi></h2>\n<figcaption>";
    if (failed) out += "<span class=\"failed\">failed: " + escaped(job.error) + "</span>";
    else out += escaped(caption(job));
    for (const std::string& note : job.notes) out += "<br>" + escaped(note);
    return out + "</figcaption>\n</figure>\n";
}

} // namespace

const char gallery_mark[] = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                            "<title>acdf batch: gallery</title>\n";

std::string gallery_page(const BatchReport& report, const std::string& folder, const std::vector<PlannedJob>& plan,
                         const MakeConversion& make) {
    const std::size_t failed = report.count(JobResult::Status::failed), made = report.jobs.size() - failed;
    std::string out =
        gallery_mark + std::string(closed_page_policy) + "<style>" + kStyle +
        "</style>\n</head>\n<body>\n<header>\n<h1>" + std::to_string(made) + (made == 1 ? " file" : " files") +
        (failed > 0 ? ", " + std::to_string(failed) + " failed" : "") +
        "</h1>\n<p>Each source beside its pdf in false colours, logarithmic, from violet over green to red. Each "
        "picture has its own range of colours. Dark grey: no sample falls there.</p>\n</header>\n<main>\n";
    for (const bool wanted : {false, true})
        for (std::size_t i = 0; i < report.jobs.size(); ++i)
            if ((report.jobs[i].status == JobResult::Status::failed) == wanted)
                out += figure(report.jobs[i], plan[i].job, folder, make);
    return out + "</main>\n</body>\n</html>\n";
}

} // namespace acdf::tools
