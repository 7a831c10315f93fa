#include "mapping/odometry/patch_alignment.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

constexpr int kMaxIterations = 12;
constexpr double kSettled_px = 0.01;

constexpr std::size_t kLanes = 12;  // sums run in lanes that fit vector registers, in a fixed order

template <std::size_t N>
float total(const std::array<float, N>& samples) {
  static_assert(N % kLanes == 0);
  std::array<float, kLanes> lanes{};
  for (std::size_t i = 0; i < N; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) lanes[j] += samples[i + j];
  }
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

template <std::size_t N>
float dot(const std::array<float, N>& a, const std::array<float, N>& b) {
  static_assert(N % kLanes == 0);
  std::array<float, kLanes> lanes{};
  for (std::size_t i = 0; i < N; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) lanes[j] += a[i + j] * b[i + j];
  }
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

template <std::size_t N>
void take_mean_away(std::array<float, N>& samples) {
  const float mean = total(samples) / static_cast<float>(N);
  for (float& s : samples) s -= mean;
}

/// side x side grey values around a place, bilinear, one pixel apart.
template <int side>
std::array<float, side * side> interpolate(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre) {
  const double left = centre.x() - 0.5 * (side - 1), top = centre.y() - 0.5 * (side - 1);
  const int u = static_cast<int>(left), v = static_cast<int>(top);
  const auto a = static_cast<float>(left - u), b = static_cast<float>(top - v);
  const float w00 = (1 - a) * (1 - b), w10 = a * (1 - b), w01 = (1 - a) * b, w11 = a * b;
  std::array<float, side * side> samples;
  for (int y = 0; y < side; ++y) {
    const std::uint8_t *upper = image.row(v + y) + u, *lower = image.row(v + y + 1) + u;
    float* out = samples.data() + y * side;
    for (int x = 0; x < side; ++x) {
      out[x] = w00 * upper[x] + w10 * upper[x + 1] + w01 * lower[x] + w11 * lower[x + 1];
    }
  }
  return samples;
}

}  // namespace

PatchSource::PatchSource(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre_px) {
  const int left = static_cast<int>(std::floor(centre_px.x())) - kSide / 2 + 1;
  const int top = static_cast<int>(std::floor(centre_px.y())) - kSide / 2 + 1;
  centre_ = centre_px - Eigen::Vector2d(left, top);
  for (int y = 0; y < kSide; ++y) std::copy_n(image.row(top + y) + left, kSide, grey_.begin() + y * kSide);
}

PatchSource::Samples PatchSource::sample(const Eigen::Matrix2d& source_from_picture) const {
  const Eigen::Matrix2f step = source_from_picture.cast<float>();
  const Eigen::Vector2f first =
      centre_.cast<float>() - step * Eigen::Vector2f::Constant(0.5F * (kSampleSide - 1));
  constexpr float kLimit = static_cast<float>(kSide) - 1.001F;
  Samples samples;
  for (int row = 0; row < kSampleSide; ++row) {
    const Eigen::Vector2f start = first + static_cast<float>(row) * step.col(1);
    std::array<int, kSampleSide> index;  // one step after the other, each for the whole row at once
    std::array<float, kSampleSide> a, b, upper, upper_next, lower, lower_next;
    for (int i = 0; i < kSampleSide; ++i) {
      const float x = std::clamp(start.x() + static_cast<float>(i) * step(0, 0), 0.0F, kLimit);
      const float y = std::clamp(start.y() + static_cast<float>(i) * step(1, 0), 0.0F, kLimit);
      const int u = static_cast<int>(x), v = static_cast<int>(y);
      a[i] = x - static_cast<float>(u);
      b[i] = y - static_cast<float>(v);
      index[i] = v * kSide + u;
    }
    for (int i = 0; i < kSampleSide; ++i) {
      const std::uint8_t* p = grey_.data() + index[i];
      upper[i] = p[0];
      upper_next[i] = p[1];
      lower[i] = p[kSide];
      lower_next[i] = p[kSide + 1];
    }
    for (int i = 0; i < kSampleSide; ++i) {
      const float top = upper[i] + a[i] * (upper_next[i] - upper[i]);
      const float bottom = lower[i] + a[i] * (lower_next[i] - lower[i]);
      samples[row * kSampleSide + i] = top + b[i] * (bottom - top);
    }
  }
  return samples;
}

PatchAligner::PatchAligner(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre_px)
    : PatchAligner(interpolate<PatchSource::kSampleSide>(image, centre_px)) {}

PatchAligner::PatchAligner(const PatchSource::Samples& wide) {
  constexpr int kWide = PatchSource::kSampleSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float* p = wide.data() + (y + 1) * kWide + x + 1;
      patch_[y * kSide + x] = p[0];
      gradient_x_[y * kSide + x] = 0.5F * (p[1] - p[-1]);
      gradient_y_[y * kSide + x] = 0.5F * (p[kWide] - p[-kWide]);
    }
  }
  take_mean_away(patch_);
  take_mean_away(gradient_x_);
  take_mean_away(gradient_y_);
  variance_ = dot(patch_, patch_);
  const double xx = dot(gradient_x_, gradient_x_), yy = dot(gradient_y_, gradient_y_);
  const double xy = dot(gradient_x_, gradient_y_);
  const double xp = -dot(gradient_x_, patch_), yp = -dot(gradient_y_, patch_);
  Eigen::Matrix3d plane;
  plane << xx, xy, xp, xy, yy, yp, xp, yp, variance_;
  Eigen::Matrix2d row;
  row << xx, xp, xp, variance_;
  textured_ = xx * yy - xy * xy > 1e-3 * (xx + yy) * (xx + yy) && xx + yy > kNumSamples;
  row_textured_ = xx > kNumSamples;
  plane_inverse_ = plane.inverse();
  row_inverse_ = row.inverse();
}

/// Sums of products of the picture's window with the patch.
struct PatchAligner::Sums {
  float gradient_x = 0, gradient_y = 0, patch = 0;
  float variance = 0;  // of the window, times the number of samples
};

PatchAligner::Sums PatchAligner::correlate(const Image<std::uint8_t>& image,
                                           const Eigen::Vector2d& centre) const {
  const Samples window = interpolate<kSide>(image, centre);
  const float sum = total(window);
  const float mean = sum / kNumSamples;
  return {dot(gradient_x_, window), dot(gradient_y_, window), dot(patch_, window),
          dot(window, window) - mean * sum};
}

/// Least squares for (a s_x, a s_y, a), turned into (s_x, s_y, a).
Eigen::Vector3d PatchAligner::shift_and_gain(const Sums& sums, bool row_only) const {
  if (row_only) {
    const Eigen::Vector2d x = row_inverse_ * Eigen::Vector2d(-sums.gradient_x, sums.patch);
    return {x(0) / x(1), 0, x(1)};
  }
  const Eigen::Vector3d x = plane_inverse_ * Eigen::Vector3d(-sums.gradient_x, -sums.gradient_y, sums.patch);
  return {x(0) / x(2), x(1) / x(2), x(2)};
}

std::optional<Alignment> PatchAligner::search(const Image<std::uint8_t>& image, const Eigen::Vector2d& start,
                                              double max_shift_px, bool row_only) const {
  const auto inside = [&](const Eigen::Vector2d& p) {
    return p.x() >= 5.5 && p.y() >= 5.5 && p.x() + 6.5 < image.width - 1 && p.y() + 6.5 < image.height - 1;
  };
  Eigen::Vector2d at = start;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!inside(at)) return std::nullopt;
    const Sums sums = correlate(image, at);
    const Eigen::Vector3d solved = shift_and_gain(sums, row_only);
    if (!(solved(2) > 0.1) || !solved.allFinite())
      return std::nullopt;  // not even the contrast's sign is right
    const Eigen::Vector2d shift = solved.head<2>().cwiseMax(-1.5).cwiseMin(1.5);
    if (shift.norm() < kSettled_px) {
      return Alignment{at + shift, sums.patch / std::sqrt(std::max(variance_ * sums.variance, 1e-6F))};
    }
    at += shift;
    if ((at - start).norm() > max_shift_px) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Alignment> PatchAligner::find(const Image<std::uint8_t>& image, const Eigen::Vector2d& start,
                                            double max_shift_px) const {
  if (!textured_) return std::nullopt;
  return search(image, start, max_shift_px, false);
}

std::optional<Alignment> PatchAligner::find_in_row(const Image<std::uint8_t>& image,
                                                   const Eigen::Vector2d& start, double max_shift_px) const {
  if (!row_textured_) return std::nullopt;
  return search(image, start, max_shift_px, true);
}

}  // namespace flogmap
