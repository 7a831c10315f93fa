// Why a frame has no pose, or a weak one: in words, for people.
#pragma once

#include <string>

#include "camera/image.hpp"
#include "mapping/odometry/frame_features.hpp"

namespace flogmap {

inline constexpr const char* kFixedBadly =
    "the landmarks found again do not fix the pose: far away, bunched or in a line";

/// "what (count of needed needed)".
[[nodiscard]] std::string counted(const std::string& what, int count, int needed);

/// Many corners, but fewer than a third of them with a disparity. Of the recordings known, swapped pictures
/// leave a disparity to 1 to 29 % of the corners, right ones to 64 % or more.
[[nodiscard]] bool hardly_any_disparity(const FrameFeatures& features);

/// For a frame with fewer usable corners than `needed`: too dark; swapped pictures; blocked (the picture is
/// of one grey); too fast (blurred: it has been better, and light and shade are still there); or just too
/// few.
[[nodiscard]] std::string why_too_few_corners(const Image<std::uint8_t>& left, const FrameFeatures& features,
                                              int needed, bool has_been_better);

/// What a key frame has in common with a frame, at most.
struct SeenAgain {
  int most_alike = 0;     // corners that look just as there, upright; by chance none does
  int most_agreeing = 0;  // that fit one motion
};

/// For a frame with corners whose motion is not found: the scene has moved (enough looks just as before, but
/// not where it was), or it moved too fast or is elsewhere (nothing looks as before).
[[nodiscard]] std::string why_no_motion(const SeenAgain& seen, int needed);

}  // namespace flogmap
