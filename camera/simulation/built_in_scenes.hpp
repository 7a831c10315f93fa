#pragma once

#include <span>
#include <string_view>

namespace flogmap {

/// A scene of camera/simulation/scenes, compiled into the program.
struct BuiltInScene {
  std::string_view name, json;
};

extern const std::span<const BuiltInScene> kBuiltInScenes;

}  // namespace flogmap
