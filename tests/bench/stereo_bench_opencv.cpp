#include "tests/bench/stereo_bench_opencv.hpp"

#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace flogmap {
namespace {

constexpr int kScale = 16;  // OpenCV's disparities are in 1/16 px
constexpr int kWindow = 9;  // of StereoBM
constexpr int kBlock = 3;   // of StereoSGBM
constexpr int kBorder = 8;

/// The settings its users take: block 3, P1 and P2 as in OpenCV's own example, left/right check, 10 % lead.
cv::Ptr<cv::StereoMatcher> opencv_matcher(OpenCvMode mode, int num_disparities) {
  if (mode == OpenCvMode::bm) {
    auto matcher = cv::StereoBM::create(num_disparities, kWindow);
    matcher->setDisp12MaxDiff(1);
    return matcher;
  }
  constexpr int kArea = kBlock * kBlock;
  const int kind = mode == OpenCvMode::sgbm_3way ? cv::StereoSGBM::MODE_SGBM_3WAY : cv::StereoSGBM::MODE_HH4;
  return cv::StereoSGBM::create(0, num_disparities, kBlock, 8 * kArea, 32 * kArea, 1, 63, 10, 0, 0, kind);
}

cv::Mat bordered(const Image<std::uint8_t>& image, int left) {
  const cv::Mat view(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat out;
  cv::copyMakeBorder(view, out, kBorder, kBorder, left, kBorder, cv::BORDER_REPLICATE);
  return out;
}

class OpenCvMatcher : public DisparityMatcher {
 public:
  OpenCvMatcher(OpenCvMode mode, int num_disparities)
      : left_border_(num_disparities + kBorder), matcher_(opencv_matcher(mode, num_disparities)) {}

  DisparityImage match(const RectifiedFrame& pair) override {
    cv::setNumThreads(1);
    cv::Mat disparity;
    matcher_->compute(bordered(pair.left, left_border_), bordered(pair.right, left_border_), disparity);
    DisparityImage out{Image<float>(pair.left.width, pair.left.height)};
    for (int y = 0; y < out.px.height; ++y) {
      const auto* from = disparity.ptr<short>(y + kBorder) + left_border_;
      for (int x = 0; x < out.px.width; ++x) {
        out.px.at(x, y) =
            from[x] < 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(from[x]) / kScale;
      }
    }
    return out;
  }

 private:
  int left_border_;
  cv::Ptr<cv::StereoMatcher> matcher_;
};

}  // namespace

std::unique_ptr<DisparityMatcher> make_opencv_matcher(OpenCvMode mode, int num_disparities) {
  return std::make_unique<OpenCvMatcher>(mode, num_disparities);
}

}  // namespace flogmap
