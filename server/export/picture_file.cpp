#include "server/export/picture_file.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace flogmap {
namespace {

std::string encode(const cv::Mat& pixels) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", pixels, bytes)) throw std::runtime_error("OpenCV cannot write PNG");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string png_of(const Image<std::uint8_t>& grey) {
  std::vector<std::uint8_t> pixels = grey.pixels;
  return encode(cv::Mat(grey.height, grey.width, CV_8UC1, pixels.data()));
}

std::string png_of(const Image<Rgb>& colour) {
  cv::Mat pixels(colour.height, colour.width, CV_8UC3);
  for (int y = 0; y < colour.height; ++y) {
    for (int x = 0; x < colour.width; ++x) {
      const auto [r, g, b] = colour.at(x, y);
      pixels.at<cv::Vec3b>(y, x) = {b, g, r};
    }
  }
  return encode(pixels);
}

std::string png_of(const Image<GreyAlpha>& grey) {
  cv::Mat pixels(grey.height, grey.width, CV_8UC4);
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x) {
      const auto [value, alpha] = grey.at(x, y);
      pixels.at<cv::Vec4b>(y, x) = {value, value, value, alpha};
    }
  }
  return encode(pixels);
}

}  // namespace flogmap
