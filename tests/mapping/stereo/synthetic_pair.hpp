// Rectified pairs whose disparity is known because we made them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "camera/stereo_frame.hpp"

namespace flogmap {

/// Random grey values, smoothed a little so that they can be sampled between pixels.
inline Image<float> random_texture(std::mt19937& random, int width, int height) {
  std::uniform_real_distribution<float> grey(0, 255);
  Image<float> raw(width, height), smooth(width, height);
  for (float& value : raw.pixels) value = grey(random);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int l = std::max(x - 1, 0), r = std::min(x + 1, width - 1);
      smooth.at(x, y) = 0.25F * raw.at(l, y) + 0.5F * raw.at(x, y) + 0.25F * raw.at(r, y);
    }
  }
  return smooth;
}

/// Linear between two pixels of a row, clamped at its ends.
inline float sample(const Image<float>& image, double x, int y) {
  const double inside = std::clamp(x, 0.0, image.width - 1.0);
  const int low = static_cast<int>(inside), high = std::min(low + 1, image.width - 1);
  const auto part = static_cast<float>(inside - low);
  return (1 - part) * image.at(low, y) + part * image.at(high, y);
}

/// A surface given in the left picture: right(x - d(x, y), y) = left(x, y). `disparity` must be smooth enough
/// for x - d to increase with x. The right picture is the random one, the left is sampled from it.
inline RectifiedFrame pair_of_surface(std::mt19937& random, int width, int height,
                                      const std::function<double(int, int)>& disparity) {
  const Image<float> texture = random_texture(random, width, height);
  RectifiedFrame pair{0, Image<std::uint8_t>(width, height), Image<std::uint8_t>(width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      pair.right.at(x, y) = static_cast<std::uint8_t>(std::lround(texture.at(x, y)));
      pair.left.at(x, y) = static_cast<std::uint8_t>(std::lround(sample(texture, x - disparity(x, y), y)));
    }
  }
  return pair;
}

/// The whole picture at one disparity.
inline RectifiedFrame shifted_pair(std::mt19937& random, int width, int height, double disparity) {
  return pair_of_surface(random, width, height, [=](int, int) { return disparity; });
}

}  // namespace flogmap
