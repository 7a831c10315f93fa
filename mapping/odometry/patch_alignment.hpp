// Finds a small patch in another picture to a few hundredths of a pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "camera/image.hpp"

namespace flogmap {

/// A cut-out around a corner, large enough to be turned, enlarged and slanted afterwards.
class PatchSource {
 public:
  /// `centre_px` must lie at least kMargin pixels inside the image.
  PatchSource(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre_px);

  static constexpr int kMargin = 15;

  static constexpr int kSampleSide = 14;
  using Samples = std::array<float, kSampleSide * kSampleSide>;

  /// 14 x 14 grey values around the centre, bilinear, `source_from_picture` apart; clamped to the cut-out.
  [[nodiscard]] Samples sample(const Eigen::Matrix2d& source_from_picture) const;

 private:
  static constexpr int kSide = 28;
  Eigen::Vector2d centre_;  // within the cut-out
  std::array<std::uint8_t, kSide * kSide> grey_;
};

/// Where a patch was found, and how well it looks like it there.
struct Alignment {
  Eigen::Vector2d px;
  double correlation = 0;  // normalised, at most 1
};

/// A patch of 12 x 12 samples, ready to be looked for. Brightness and contrast may differ between pictures:
///   I(x + s) = a P(x) + b - a grad P(x) s    is solved for shift s, gain a and offset b, again and again.
class PatchAligner {
 public:
  /// The patch as a picture would show it that sees `source_from_picture` times its offsets.
  PatchAligner(const PatchSource& source, const Eigen::Matrix2d& source_from_picture)
      : PatchAligner(source.sample(source_from_picture)) {}

  /// The patch around a place at least PatchSource::kMargin pixels inside a picture, as it stands there.
  PatchAligner(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre_px);

  /// Looks from `start` in both directions; nothing if it wanders off by more than `max_shift_px`, leaves the
  /// picture, does not settle or has no texture.
  [[nodiscard]] std::optional<Alignment> find(const Image<std::uint8_t>& image, const Eigen::Vector2d& start,
                                              double max_shift_px) const;

  /// The same along a row only.
  [[nodiscard]] std::optional<Alignment> find_in_row(const Image<std::uint8_t>& image,
                                                     const Eigen::Vector2d& start, double max_shift_px) const;

 private:
  static constexpr int kSide = 12;
  static constexpr int kNumSamples = kSide * kSide;
  using Samples = std::array<float, kNumSamples>;

  explicit PatchAligner(const PatchSource::Samples& wide);
  struct Sums;
  [[nodiscard]] Sums correlate(const Image<std::uint8_t>& image, const Eigen::Vector2d& centre) const;
  [[nodiscard]] Eigen::Vector3d shift_and_gain(const Sums& sums, bool row_only) const;
  [[nodiscard]] std::optional<Alignment> search(const Image<std::uint8_t>& image,
                                                const Eigen::Vector2d& start, double max_shift_px,
                                                bool row_only) const;

  Samples patch_, gradient_x_, gradient_y_;  // all with their means taken away
  float variance_ = 0;                       // sum of squares of patch_
  Eigen::Matrix3d plane_inverse_;            // of the normal equations for (x, y, gain)
  Eigen::Matrix2d row_inverse_;              // for (x, gain)
  bool textured_ = false, row_textured_ = false;
};

}  // namespace flogmap
