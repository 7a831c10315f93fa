#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "mapping/odometry/features.hpp"

namespace flogmap {
namespace {

constexpr int kSamplesPerSide = 8;
constexpr float kSampleStepPx = 2.5F;
constexpr float kGreyPerSigma = 32;  // a descriptor's unit: 1/32 standard deviation

/// A blurred copy: each sample then stands for its surroundings.
Image<std::uint8_t> blurred(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> smooth(image.width, image.height);
  const cv::Mat from(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat to(image.height, image.width, CV_8U, smooth.pixels.data());
  cv::blur(from, to, cv::Size(3, 3));
  return smooth;
}

float clamped(const Image<std::uint8_t>& image, float x, float y) {
  const int u = std::clamp(static_cast<int>(std::floor(x + 0.5F)), 0, image.width - 1);
  const int v = std::clamp(static_cast<int>(std::floor(y + 0.5F)), 0, image.height - 1);
  return image.at(u, v);
}

/// The direction from the corner to the centre of brightness of the disc around it (Rosin 1999).
Eigen::Vector2f own_direction(const Image<std::uint8_t>& image, const Eigen::Vector2f& centre, float scale) {
  constexpr int kRadius = 7;
  const float step = scale * 1.3F;
  Eigen::Vector2f moment = Eigen::Vector2f::Zero();
  for (int v = -kRadius; v <= kRadius; ++v) {
    for (int u = -kRadius; u <= kRadius; ++u) {
      if (u * u + v * v > kRadius * kRadius) continue;
      const Eigen::Vector2f offset(static_cast<float>(u), static_cast<float>(v));
      const Eigen::Vector2f at = centre + step * offset;
      moment += clamped(image, at.x(), at.y()) * offset;
    }
  }
  const float length = moment.norm();
  return length > 0 ? Eigen::Vector2f(moment / length) : Eigen::Vector2f(1, 0);
}

/// Mean taken away, contrast made equal, 128 in the middle.
Descriptor normalised(const std::array<float, 64>& samples) {
  float sum = 0, sum_of_squares = 0;
  for (const float s : samples) {
    sum += s;
    sum_of_squares += s * s;
  }
  const float mean = sum / 64;
  const float sigma = std::sqrt(std::max(sum_of_squares / 64 - mean * mean, 1.0F));
  Descriptor descriptor;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float grey = 128.5F + kGreyPerSigma * (samples[i] - mean) / sigma;
    descriptor[i] = static_cast<std::uint8_t>(std::clamp(grey, 0.0F, 255.0F));
  }
  return descriptor;
}

Descriptor describe_one(const Image<std::uint8_t>& smooth, const Eigen::Vector2f& centre, PatchFrame frame,
                        float scale) {
  const Eigen::Vector2f x_axis =
      kSampleStepPx * scale *
      (frame == PatchFrame::upright ? Eigen::Vector2f(1, 0) : own_direction(smooth, centre, scale));
  const Eigen::Vector2f y_axis(-x_axis.y(), x_axis.x());
  std::array<float, 64> samples{};
  for (int v = 0; v < kSamplesPerSide; ++v) {
    for (int u = 0; u < kSamplesPerSide; ++u) {
      const Eigen::Vector2f at =
          centre + (static_cast<float>(u) - 3.5F) * x_axis + (static_cast<float>(v) - 3.5F) * y_axis;
      samples[v * kSamplesPerSide + u] = clamped(smooth, at.x(), at.y());
    }
  }
  return normalised(samples);
}

/// Sum of absolute differences; written so that compilers use their instruction for it.
int difference(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

struct Best {
  int difference = std::numeric_limits<int>::max();
  int index = -1;
};

void keep_better(Best& best, int difference, int index) {
  if (difference < best.difference) best = {difference, index};
}

}  // namespace

std::vector<Descriptor> describe(const Image<std::uint8_t>& image, const std::vector<Corner>& corners,
                                 PatchFrame frame, const std::vector<float>& scales) {
  if (corners.empty()) return {};
  const Image<std::uint8_t> smooth = blurred(image);
  std::vector<Descriptor> descriptors;
  descriptors.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    descriptors.push_back(describe_one(smooth, corners[i].px, frame, scales.empty() ? 1.0F : scales[i]));
  }
  return descriptors;
}

double mean_difference(const Descriptor& a, const Descriptor& b) {
  return difference(a, b) / (64.0 * kGreyPerSigma);
}

std::vector<IndexPair> match_mutually(const std::vector<Descriptor>& key,
                                      const std::vector<Descriptor>& current, double max_difference) {
  std::vector<Best> of_key(key.size()), of_current(current.size());
  for (std::size_t i = 0; i < key.size(); ++i) {
    for (std::size_t j = 0; j < current.size(); ++j) {
      const int d = difference(key[i], current[j]);
      keep_better(of_key[i], d, static_cast<int>(j));
      keep_better(of_current[j], d, static_cast<int>(i));
    }
  }
  const int limit = static_cast<int>(max_difference * kGreyPerSigma * 64);
  std::vector<IndexPair> pairs;
  for (int i = 0; i < static_cast<int>(key.size()); ++i) {
    const Best& best = of_key[i];
    if (best.index >= 0 && best.difference <= limit && of_current[best.index].index == i) {
      pairs.push_back({i, best.index});
    }
  }
  return pairs;
}

}  // namespace flogmap
