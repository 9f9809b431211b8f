// What is wrong with what `acdf render` is told.
#pragma once

#include <stdexcept>

namespace acdf::tools {

/// What is wrong with a scene: one line that begins with where, "objects[2].sphere.radius: ...".
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What is wrong with the text of a sampler, of a scene or of an option: one line.
struct SpecError : SceneError {
    using SceneError::SceneError;
};

} // namespace acdf::tools
