#pragma once

#include <cstdint>
#include <vector>

#include "camera/image.hpp"
#include "camera/simulation/scene.hpp"

namespace flogmap {

/// What lens and sensor add to an ideal picture; the same seed and frame give the same picture.
class SensorModel {
 public:
  SensorModel(const Sensor& sensor, std::uint64_t seed);

  /// Blur, gain (right only), noise.
  void expose(Image<std::uint8_t>& grey, std::int64_t frame, bool right) const;

  /// Does the driver lose this pair?
  [[nodiscard]] bool drops(std::int64_t frame) const;

 private:
  void add_noise(Image<std::uint8_t>& grey, std::int64_t frame, bool right) const;

  Sensor sensor_;
  std::uint64_t seed_;
  std::vector<std::int16_t> noise_;  // normal, in greys; every row of a picture starts somewhere else in it
};

}  // namespace flogmap
