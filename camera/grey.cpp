#include "camera/grey.hpp"

#include <opencv2/imgproc.hpp>

namespace flogmap {

Image<std::uint8_t> to_grey(const Picture& picture) {
  const int depth = picture.bits == 16 ? CV_16U : CV_8U;
  // OpenCV has no read-only view; the matrix is only read.
  const cv::Mat view(picture.height, picture.width, CV_MAKETYPE(depth, picture.channels),
                     const_cast<std::uint8_t*>(picture.bytes.data()));
  cv::Mat grey = view;
  if (picture.channels == 3) cv::cvtColor(view, grey, cv::COLOR_BGR2GRAY);
  Image<std::uint8_t> out(picture.width, picture.height);
  cv::Mat target(out.height, out.width, CV_8U, out.pixels.data());
  if (picture.bits == 16)
    grey.convertTo(target, CV_8U, 1.0 / 256);
  else
    grey.copyTo(target);
  return out;
}

}  // namespace flogmap
