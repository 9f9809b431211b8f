// Which layout an image has: what the user says, what the file says, or what its shape and texels prove.
#pragma once

#include "build/probe/projection.h"
#include "input/probe/image.h"
#include "input/probe/latlong_check.h"
#include "input/probe/probe.h"

#include <string>

namespace acdf::input {

struct Detected {
    build::Layout layout = build::Layout::latlong;
    std::string reason;           ///< for a person
    bool back_is_upright = false; ///< of a vertical cross, where that face hangs upside down
};

/// Decides, or throws Error (naming `path`, the shape and the options) where the image is not what
/// `options.projection` needs, or, for Projection::automatic, where nothing proves one layout. Never guesses from
/// the file's name. What it takes for lat-long by its shape alone a LatlongCheck is to look at.
Detected detect_layout(const std::string& path, const Image& image, const ProbeOptions& options);

/// Throws Error where something speaks against a lat-long map.
void refuse_latlong(const std::string& path, const Image& image, const LatlongCheck& check);

/// Whether detect_layout will say lat-long, whatever the pixels are: it needs none then.
bool is_latlong(const Image& image, Projection projection);

/// Whether it says so by the shape alone.
bool is_latlong_by_shape(const Image& image, Projection projection);

/// The projection a layout belongs to.
Projection projection_of(build::Layout layout);

} // namespace acdf::input
