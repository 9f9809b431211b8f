// What renderers do with their maps: the builder's table.
#include "python/options.h"

#include "build/text/format_names.h"
#include "build/text/options.h"

namespace acdf::python {
namespace {

using namespace acdf::builder;

/// The name for `channel` that stands for these.
const char* channel_name(const Channels& channels) {
    for (const build::ChannelName& name : build::channel_names)
        if (name.channels == channels.mode && name.weights.r == channels.weights.r &&
            name.weights.g == channels.weights.g && name.weights.b == channels.weights.b)
            return name.name;
    return "";
}

py::tuple axes_of(const Axes& axes) { return py::make_tuple(axes.x, axes.y, axes.z); }

py::list all_renderers() {
    py::list out;
    for (const Renderer& renderer : renderers()) {
        const TargetOptions& target = renderer.target;
        py::dict one;
        one["name"] = renderer.name;
        one["domain"] = target.domain == Domain::octahedral ? "octahedral" : "latlong";
        one["filter"] = build::filter_name(target.filter);
        one["wrap"] = target.wrap == Wrap::repeat ? "repeat" : "clamp";
        one["channel"] = channel_name(target.channels);
        one["axes"] = axes_of(renderer.axes);
        one["mirrorball_axes"] = renderer.mirrorball ? py::object(axes_of(*renderer.mirrorball)) : py::none();
        out.append(one);
    }
    return out;
}

} // namespace

void add_renderers(py::module_& module) { module.def("renderers", &all_renderers); }

} // namespace acdf::python
