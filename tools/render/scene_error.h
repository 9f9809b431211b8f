// Errors in the input of `acdf render`.
#pragma once

#include <stdexcept>

namespace acdf::tools {

/// An error in a scene: one line that begins with the key, "objects[2].sphere.radius: ...".
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An error in the text of a sampler, in a scene or in an option: one line.
struct SpecError : SceneError {
    using SceneError::SceneError;
};

} // namespace acdf::tools
