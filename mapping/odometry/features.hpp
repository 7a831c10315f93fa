// Corners of a picture, what they look like, and which of them look alike. FLOG.md section 9.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "camera/image.hpp"

namespace flogmap {

struct CornerOptions {
  int max_corners = 500;
  int cell_px = 40;  // corners are picked cell by cell, so that they cover the picture
  int max_per_cell = 6;
  float min_strength = 1;  // smaller eigenvalue of the mean gradient products, grey levels^2 per px^2
};

/// A corner of the left picture, to a fraction of a pixel.
struct Corner {
  Eigen::Vector2f px;
  float strength = 0;  // as CornerOptions::min_strength
};

/// No corner lies nearer to the border than this: its patch must fit in at any orientation.
inline constexpr int kCornerBorderPx = 16;

/// The strongest corners, spread over the picture: first the best of every cell, then the second best, ...
[[nodiscard]] std::vector<Corner> detect_corners(const Image<std::uint8_t>& image,
                                                 const CornerOptions& options);

/// A patch around a corner: 8 x 8 samples, their mean taken away and their contrast made equal.
using Descriptor = std::array<std::uint8_t, 64>;

/// How the samples of a patch lie in the picture.
enum class PatchFrame {
  upright,          // along rows and columns: the most distinctive, survives about 20 degrees of roll
  own_orientation,  // turned to the patch's own direction: survives any roll
};

/// Describes corners of the same picture. `scales` enlarges each patch (1 = 8 x 8 samples 2.5 px apart);
/// empty means 1 for all. Patches are clamped at the picture's border.
[[nodiscard]] std::vector<Descriptor> describe(const Image<std::uint8_t>& image,
                                               const std::vector<Corner>& corners, PatchFrame frame,
                                               const std::vector<float>& scales = {});

/// Mean difference of a sample, in standard deviations of the patch.
[[nodiscard]] double mean_difference(const Descriptor& a, const Descriptor& b);

/// A corner of the key frame and one of the current frame that may be the same point.
struct IndexPair {
  int key = 0;
  int current = 0;
  bool operator==(const IndexPair&) const = default;
};

/// Pairs that choose each other as the most alike, anywhere in the picture. `max_difference` is the largest
/// mean_difference(). Ordered by the key's index.
[[nodiscard]] std::vector<IndexPair> match_mutually(const std::vector<Descriptor>& key,
                                                    const std::vector<Descriptor>& current,
                                                    double max_difference);

}  // namespace flogmap
