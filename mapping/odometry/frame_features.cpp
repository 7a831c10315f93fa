#include "mapping/odometry/frame_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/odometry/patch_alignment.hpp"

namespace flogmap {
namespace {

constexpr float kLeastDisparity_px = 0.5F;  // beyond, eq. (1) is too far from linear
constexpr double kLeastCorrelation = 0.8;

/// The valid disparity nearest to a corner, at most 2 px away; NaN if there is none.
float disparity_near(const Image<float>& disparity, const Eigen::Vector2f& px) {
  const int x = static_cast<int>(px.x() + 0.5F), y = static_cast<int>(px.y() + 0.5F);
  int nearest = std::numeric_limits<int>::max();
  float found = std::numeric_limits<float>::quiet_NaN();
  for (int v = -2; v <= 2; ++v) {
    for (int u = -2; u <= 2; ++u) {
      if (!disparity.contains(x + u, y + v) || u * u + v * v >= nearest) continue;
      const float d = disparity.at(x + u, y + v);
      if (!(d >= kLeastDisparity_px)) continue;
      nearest = u * u + v * v;
      found = d;
    }
  }
  return found;
}

}  // namespace

FrameFeatures extract_features(const StereoCamera& camera, const Image<std::uint8_t>& left,
                               const DisparityImage& disparity, const CornerOptions& options) {
  FrameFeatures features;
  for (const Corner& corner : detect_corners(left, options)) {
    const float d = disparity_near(disparity.px, corner.px);
    if (std::isnan(d)) {
      ++features.num_without_disparity;
      continue;
    }
    features.corners.push_back(corner);
    features.disparity_px.push_back(d);
    features.points.push_back(triangulate(camera, corner.px.x(), corner.px.y(), d));
  }
  features.upright = describe(left, features.corners, PatchFrame::upright);
  return features;
}

std::vector<float> scales_by_nearness(const FrameFeatures& features, float disparity_of_scale_1) {
  std::vector<float> scales;
  for (const float d : features.disparity_px)
    scales.push_back(std::clamp(d / disparity_of_scale_1, 0.4F, 4.0F));
  return scales;
}

std::optional<double> refine_disparity(const RectifiedFrame& frame, const Eigen::Vector2d& px,
                                       double disparity_px, const Slant& slant) {
  const double margin = PatchSource::kMargin;
  const bool inside = px.x() >= margin && px.y() >= margin && px.x() < frame.left.width - margin &&
                      px.y() < frame.left.height - margin;
  if (!inside) return std::nullopt;
  const PatchAligner aligner = slant.isZero()
                                   ? PatchAligner(frame.left, px)
                                   : PatchAligner(PatchSource(frame.left, px), left_from_right(slant));
  const auto found = aligner.find_in_row(frame.right, px - Eigen::Vector2d(disparity_px, 0), 1.5);
  if (!found || found->correlation < kLeastCorrelation) return std::nullopt;
  const double d = px.x() - found->px.x();
  return d >= kLeastDisparity_px ? std::optional(d) : std::nullopt;
}

}  // namespace flogmap
