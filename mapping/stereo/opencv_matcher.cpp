#include "mapping/stereo/opencv_matcher.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace flogmap {
namespace {

constexpr int kScale = 16;  // OpenCV's disparities are in 1/16 px
constexpr int kWindow = 9;

cv::Ptr<cv::StereoMatcher> opencv_matcher(const StereoOptions& options, int num_disparities) {
  if (options.matcher == MatcherKind::block) {
    auto matcher = cv::StereoBM::create(num_disparities, kWindow);
    matcher->setMinDisparity(options.min_disparity);
    matcher->setDisp12MaxDiff(1);
    return matcher;
  }
  constexpr int kBlock = 3, kP = kBlock * kBlock;
  return cv::StereoSGBM::create(options.min_disparity, num_disparities, kBlock, 8 * kP, 32 * kP, 1, 63, 10, 0,
                                0, cv::StereoSGBM::MODE_SGBM_3WAY);
}

class OpenCvMatcher : public DisparityMatcher {
 public:
  explicit OpenCvMatcher(const StereoOptions& options)
      : min_disparity_(options.min_disparity),
        num_disparities_((options.num_disparities + 15) / 16 * 16),
        matcher_(opencv_matcher(options, num_disparities_)) {}

  DisparityImage match(const RectifiedFrame& pair) override {
    // Both pictures get borders: OpenCV answers nothing where the search range leaves the right picture.
    const int border = kWindow, left = std::max(0, min_disparity_ + num_disparities_) + border;
    const cv::Mat l = padded(pair.left, left, border), r = padded(pair.right, left, border);
    cv::Mat disparity;
    matcher_->compute(l, r, disparity);
    DisparityImage out{Image<float>(pair.left.width, pair.left.height)};
    for (int y = 0; y < out.px.height; ++y) {
      const auto* from = disparity.ptr<short>(y + border) + left;
      for (int x = 0; x < out.px.width; ++x) {
        out.px.at(x, y) = from[x] < min_disparity_ * kScale ? std::numeric_limits<float>::quiet_NaN()
                                                            : static_cast<float>(from[x]) / kScale;
      }
    }
    return out;
  }

 private:
  static cv::Mat padded(const Image<std::uint8_t>& image, int left, int border) {
    const cv::Mat view(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
    cv::Mat out;
    cv::copyMakeBorder(view, out, border, border, left, border, cv::BORDER_REPLICATE);
    return out;
  }

  int min_disparity_;
  int num_disparities_;
  cv::Ptr<cv::StereoMatcher> matcher_;
};

}  // namespace

std::unique_ptr<DisparityMatcher> make_opencv_matcher(const StereoOptions& options) {
  return std::make_unique<OpenCvMatcher>(options);
}

}  // namespace flogmap
