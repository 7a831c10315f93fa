#include "camera/simulation/sensor_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>

namespace flogmap {
namespace {

constexpr std::size_t kNoiseValues = 1U << 16;
constexpr std::size_t kLongestRow = 8192;

/// A well mixed 64-bit value (the finalizer of SplitMix64, Steele, Lea and Flood 2014).
std::uint64_t mixed_64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

double uniform(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace

SensorModel::SensorModel(const Sensor& sensor, std::uint64_t seed) : sensor_(sensor), seed_(seed) {
  if (sensor_.noise_grey <= 0) return;
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < kNoiseValues + kLongestRow; ++i) {
    // Box and Muller's transform: std::normal_distribution differs from library to library.
    const double radius = std::sqrt(-2 * std::log(1 - uniform(random())));
    const double normal = radius * std::cos(2 * std::numbers::pi * uniform(random()));
    noise_.push_back(
        static_cast<std::int16_t>(std::lround(std::clamp(sensor_.noise_grey * normal, -255.0, 255.0))));
  }
}

void SensorModel::expose(Image<std::uint8_t>& grey, std::int64_t frame, bool right) const {
  cv::Mat view(grey.height, grey.width, CV_8U, grey.pixels.data());
  if (sensor_.blur_px > 0) cv::GaussianBlur(view, view, {0, 0}, sensor_.blur_px);
  if (right && sensor_.right_gain != 1) view.convertTo(view, -1, sensor_.right_gain);
  if (!noise_.empty()) add_noise(grey, frame, right);
}

void SensorModel::add_noise(Image<std::uint8_t>& grey, std::int64_t frame, bool right) const {
  std::uint64_t bits = mixed_64(seed_ ^ mixed_64(2 * static_cast<std::uint64_t>(frame) + (right ? 1 : 0)));
  for (int y = 0; y < grey.height; ++y) {
    bits = mixed_64(bits);
    const std::int16_t* noise = noise_.data() + bits % kNoiseValues;
    std::uint8_t* row = grey.row(y);
    for (int x = 0; x < grey.width; ++x) {
      row[x] = static_cast<std::uint8_t>(std::clamp<int>(row[x] + noise[x], 0, 255));
    }
  }
}

bool SensorModel::drops(std::int64_t frame) const {
  return uniform(mixed_64(~seed_ ^ mixed_64(static_cast<std::uint64_t>(frame)))) < sensor_.drop_probability;
}

}  // namespace flogmap
