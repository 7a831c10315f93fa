#pragma once

#include <string>
#include <vector>

#include "camera/simulation/scene.hpp"

namespace flogmap {

/// Reads a scene from JSON text (docs/scene-format.md). `folder` is where its OBJ and picture files are
/// looked up. Throws std::runtime_error naming origin, field, value and what is allowed; unknown keys are
/// errors.
[[nodiscard]] Scene parse_scene(const std::string& json, const std::string& origin,
                                const std::string& folder);

/// A scene that comes with the program ("room") or a file ("my.json").
[[nodiscard]] Scene load_scene(const std::string& name_or_file);

/// The names of the scenes that come with the program.
[[nodiscard]] std::vector<std::string> built_in_scenes();

}  // namespace flogmap
