#include "build/local.h"

#include "build/errors.h"
#include "build/local_draft.h"
#include "build/local_halved.h"
#include "build/text/options.h"
#include "build/text/partner.h"
#include "compress/visibility/portal_sides.h"

#include <utility>

namespace acdf::build {
namespace {

Local build_separate(const compress::Target& target, const Source& source, const LocalOptions& options,
                     const Progress& progress) {
    const compress::NormalBins bins = bins_of(options, options.subdivisions > 0 ? options.subdivisions : 6);
    compress::FitOptions fit = options.fit;
    fit.progress = [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    compress::SeparateFit fitted = compress::fit_local_separate(target, bins, options.bin_target, fit);
    compress::Description description = description_of(target, source, options, bins, {});
    description.chunks = {compress::local_chunk(static_cast<float>(options.cosine_share))};
    description.shares = std::move(fitted.shares);
    const Store store = [&](const compress::Description& of, AcdfCodec codec) {
        return compress::store(fitted.tree, of, codec);
    };
    return finish(std::move(description), store, target, source, options, bins);
}

} // namespace

std::string option_text(const std::string& reading, const LocalOptions& o) {
    std::string text = reading + target_text(o.target) + codec_text(o.codec);
    if (o.subdivisions > 0) text += "--normals " + std::to_string(o.subdivisions) + " ";
    if (o.columns > 0) text += "--normals " + std::to_string(o.columns) + "x" + std::to_string(o.rows) + " ";
    if (!o.scene_text.empty()) text += o.scene_text + " ";
    else if (!o.scene.empty()) text += "--scene ";
    text += partner_text(o.mis);
    if (o.visibility.scene && o.scene_text.find("--visibility") == std::string::npos) text += "--visibility ";
    if (o.cosine_share > 0.0) text += "--cosine-share " + option_number(o.cosine_share) + " ";
    if (o.sharing) {
        if (o.max_weight > 0.0) text += "--max-weight " + option_number(o.max_weight) + " ";
        if (o.tiles > 0) text += "--tiles " + std::to_string(o.tiles) + " ";
        return text + goal_text(o.goal);
    }
    text += "--no-sharing " + fit_text(o.fit.fit);
    if (o.bin_target == compress::BinTarget::centre) text += "--bin-target centre ";
    if (o.fit.order) text += "--order " + std::string(to_string(*o.fit.order)) + " ";
    text += "--knots " + std::to_string(o.fit.column_segments) + "x" + std::to_string(o.fit.row_segments);
    return o.fit.epsilon > 0.0 ? text + " --eps " + option_number(o.fit.epsilon) : text;
}

Local build_local(const compress::Target& target, const Source& source, const LocalOptions& options,
                  const Progress& progress) {
    if (!compress::has_energy(target)) throw NoEnergy("a target without energy");
    if (!options.sharing) return build_separate(target, source, options, progress);
    if (options.visibility.portals.empty()) return build_halved(target, source, options, progress);
    LocalOptions facing = options; // checked first: building takes long
    facing.visibility.portals =
        compress::facing_light(target, options.visibility.portals, options.visibility.scene);
    return build_halved(target, source, facing, progress);
}

} // namespace acdf::build
