// What odometry keeps of one frame: corners with disparity, and what they look like.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/odometry/features.hpp"
#include "mapping/odometry/slant.hpp"
#include "mapping/odometry/stereo_pixel.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Corners of the left picture that have a disparity; all vectors have one entry per corner.
struct FrameFeatures {
  std::vector<Corner> corners;
  std::vector<float> disparity_px;      // of the dense image, > 0
  std::vector<Eigen::Vector3d> points;  // metres, camera frame
  std::vector<Descriptor> upright;
  int num_without_disparity = 0;  // further corners, that could not be used
};

[[nodiscard]] FrameFeatures extract_features(const StereoCamera& camera, const Image<std::uint8_t>& left,
                                             const DisparityImage& disparity, const CornerOptions& options);

/// Scales for describe() that make patches the same size in metres, not in pixels: half and twice the
/// distance still look alike. `disparity_of_scale_1` is where the scale is 1.
[[nodiscard]] std::vector<float> scales_by_nearness(const FrameFeatures& features,
                                                    float disparity_of_scale_1);

/// The disparity at a corner to a fraction of a pixel: the patch around it, sheared as the right camera sees
/// a surface of that slant, is looked for in the right picture, from the dense disparity. Nothing if it is
/// not found there within 1.5 px, or too near to the border.
[[nodiscard]] std::optional<double> refine_disparity(const RectifiedFrame& frame, const Eigen::Vector2d& px,
                                                     double disparity_px, const Slant& slant);

}  // namespace flogmap
