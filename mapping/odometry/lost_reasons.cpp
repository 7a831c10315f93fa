#include "mapping/odometry/lost_reasons.hpp"

#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

constexpr double kDarkGrey = 20;
constexpr double kOneGrey = 8;        // standard deviation of a picture that shows nothing
constexpr int kMinForSwapHint = 100;  // corners without a disparity

/// Mean and standard deviation.
struct Grey {
  double mean = 0, sigma = 0;
};

Grey grey_of(const Image<std::uint8_t>& image) {
  if (image.empty()) return {};
  std::int64_t sum = 0, squares = 0;
  for (const std::uint8_t grey : image.pixels) {
    sum += grey;
    squares += std::int64_t{grey} * grey;
  }
  const auto n = static_cast<double>(image.size());
  const double mean = static_cast<double>(sum) / n;
  return {mean, std::sqrt(std::max(static_cast<double>(squares) / n - mean * mean, 0.0))};
}

}  // namespace

std::string counted(const std::string& what, int count, int needed) {
  return what + " (" + std::to_string(count) + " of " + std::to_string(needed) + " needed)";
}

bool hardly_any_disparity(const FrameFeatures& features) {
  return features.num_without_disparity >= kMinForSwapHint &&
         2 * static_cast<int>(features.corners.size()) < features.num_without_disparity;
}

std::string why_too_few_corners(const Image<std::uint8_t>& left, const FrameFeatures& features, int needed,
                                bool has_been_better) {
  const int num_corners = static_cast<int>(features.corners.size());
  const Grey grey = grey_of(left);
  if (grey.mean < kDarkGrey) return counted("too dark: too few corners", num_corners, needed);
  if (hardly_any_disparity(features)) {
    return "too few corners with a disparity (" + std::to_string(num_corners) + " of " +
           std::to_string(num_corners + features.num_without_disparity) + "), are left and right swapped?";
  }
  if (grey.sigma < kOneGrey) {
    return counted("blocked, or a plain surface fills the view: too few corners", num_corners, needed);
  }
  if (has_been_better && features.num_without_disparity < needed) {
    return counted("too fast, the picture is blurred: too few corners", num_corners, needed);
  }
  return counted("too few corners", num_corners, needed);
}

std::string why_no_motion(const SeenAgain& seen, int needed) {
  if (seen.most_alike >= needed) {
    return counted("the scene has moved: things look as before, but too few corners agree on a motion",
                   seen.most_agreeing, needed);
  }
  return counted("too fast, or somewhere else: too few corners look as before and agree on a motion",
                 seen.most_agreeing, needed);
}

}  // namespace flogmap
