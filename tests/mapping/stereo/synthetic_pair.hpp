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

/// A box in front of a wall. Occluded pixels of the left picture: just left of the box.
struct BoxPair {
  RectifiedFrame frame;
  int box_left, box_right, box_top, box_bottom;  // in the left picture, ends excluded
  int near_px, far_px;                           // disparities of box and wall

  [[nodiscard]] bool on_box(int x, int y) const {
    return x >= box_left && x < box_right && y >= box_top && y < box_bottom;
  }
  [[nodiscard]] bool occluded(int x, int y) const { return !on_box(x, y) && on_box(x - far_px + near_px, y); }
};

inline BoxPair box_pair(std::mt19937& random, int width, int height, int near_px, int far_px) {
  const Image<float> wall = random_texture(random, width + far_px, height);
  const Image<float> box = random_texture(random, width + near_px, height);
  BoxPair out{{0, Image<std::uint8_t>(width, height), Image<std::uint8_t>(width, height)},
              width * 2 / 5,
              width * 4 / 5,
              height / 4,
              height * 3 / 4,
              near_px,
              far_px};
  const auto grey = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out.frame.left.at(x, y) = grey(out.on_box(x, y) ? box.at(x, y) : wall.at(x, y));
      out.frame.right.at(x, y) =
          grey(out.on_box(x + near_px, y) ? box.at(x + near_px, y) : wall.at(x + far_px, y));
    }
  }
  return out;
}

/// What the two cameras would see in a mirror: the right one becomes the left.
inline RectifiedFrame mirrored(const RectifiedFrame& pair) {
  RectifiedFrame out{pair.timestamp_ns, pair.right, pair.left};
  for (int y = 0; y < pair.left.height; ++y) {
    std::reverse(out.left.row(y), out.left.row(y) + out.left.width);
    std::reverse(out.right.row(y), out.right.row(y) + out.right.width);
  }
  return out;
}

/// Independent noise on both pictures, clipped to the grey scale.
inline void add_noise(std::mt19937& random, double sigma, RectifiedFrame& pair) {
  std::normal_distribution<double> noise(0, sigma);
  for (Image<std::uint8_t>* image : {&pair.left, &pair.right}) {
    for (std::uint8_t& grey : image->pixels) {
      grey = static_cast<std::uint8_t>(std::clamp(std::lround(grey + noise(random)), 0L, 255L));
    }
  }
}

}  // namespace flogmap
