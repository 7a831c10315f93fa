#pragma once

#include "camera/simulation/scene_json.hpp"

namespace flogmap::testing {

/// A hall with a turned box, a cylinder and a second box, coarse enough to be painted in milliseconds.
inline constexpr const char* kSmallScene = R"({
    "camera": {"width_px": 320, "height_px": 240, "focal_px": 210, "baseline_m": 0.12, "rate_hz": 10},
    "texel_m": 0.012,
    "materials": {"rough": {"pattern": "speckle", "size_m": 0.1}, "wall": {"pattern": "plaster"},
                  "floor": {"pattern": "planks", "size_m": 0.15}},
    "solids": [
      {"hall": {"min": [-2, -2, 0], "max": [2, 2, 2.5]}, "material": "wall", "bottom": "floor", "top": "floor"},
      {"box": {"at": [0.2, 0.1, 0], "size_m": [0.6, 0.4, 0.5], "yaw_deg": 25}, "material": "rough"},
      {"box": {"min": [-1.9, 1.2, 0.8], "max": [-0.6, 1.9, 0.9]}, "material": "floor"},
      {"cylinder": {"at": [-0.7, -0.6, 0], "radius_m": 0.15, "height_m": 2.5}, "material": "rough"}
    ],
    "path": {"speed_m_s": 0.4, "tremor_m": 0.004, "tremor_deg": 0.8, "points": [
      {"at": [1.3, 0, 1.3], "look_at": [-1, 0.2, 0.7], "roll_deg": 8}, {"at": [0, 1.3, 1.2], "look_at": [0.2, -1, 0.7]},
      {"at": [-1.3, 0.2, 1.4], "look_at": [1, 0.2, 0.6], "roll_deg": -6}, {"at": [0, -1.4, 1.3], "look_at": [0, 1, 0.7]}]}
  })";

inline Scene small_scene() { return parse_scene(kSmallScene, "small scene", "."); }

}  // namespace flogmap::testing
