#include "server/picture_encoding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace flogmap {
namespace {

constexpr int kJpegQuality = 80;
constexpr int kFastPng = 1;  // compression level of 9
constexpr Colour kNoDisparity{42, 42, 46};

std::string to_string(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// As large as wanted, never larger than it is.
cv::Mat fitted(const cv::Mat& picture, int max_width_px, int interpolation) {
  const PictureSize size = fitted_size(picture.cols, picture.rows, max_width_px);
  if (size.width == picture.cols) return picture;
  cv::Mat out;
  cv::resize(picture, out, cv::Size(static_cast<int>(size.width), static_cast<int>(size.height)), 0, 0,
             interpolation);
  return out;
}

EncodedPicture described(const cv::Mat& full, const cv::Mat& sent, PictureKey key,
                         std::int64_t timestamp_ns) {
  EncodedPicture picture;
  picture.stream = key.stream;
  picture.timestamp_ns = timestamp_ns;
  picture.width_px = sent.cols;
  picture.height_px = sent.rows;
  picture.full_width_px = full.cols;
  picture.full_height_px = full.rows;
  return picture;
}

EncodedPicture encode_grey(const Image<std::uint8_t>& image, PictureKey key, std::int64_t timestamp_ns) {
  const cv::Mat full(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  const cv::Mat sent = fitted(full, key.max_width_px, cv::INTER_AREA);
  std::vector<std::uint8_t> file;
  cv::imencode(".jpg", sent, file, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  EncodedPicture picture = described(full, sent, key, timestamp_ns);
  picture.media_type = "image/jpeg";
  picture.data = to_string(file);
  return picture;
}

/// Ends of the colour scale: 0 and a round number of pixels that nearly all disparities stay below.
double scale_end_px(const Image<float>& disparity) {
  std::vector<float> valid;
  for (std::size_t i = 0; i < disparity.size(); i += 7) {
    if (std::isfinite(disparity.pixels[i])) valid.push_back(disparity.pixels[i]);
  }
  constexpr double kStep = 8;
  if (valid.empty()) return kStep;
  const auto high = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() * 99 / 100);
  std::nth_element(valid.begin(), high, valid.end());
  return std::max(kStep, std::ceil(static_cast<double>(*high) / kStep) * kStep);
}

cv::Mat coloured(const cv::Mat& disparity, double scale_end) {
  const PaletteTable& table = table_of(Palette::viridis);
  const auto bgr = [](Colour colour) { return cv::Vec3b(colour.b, colour.g, colour.r); };
  cv::Mat out(disparity.rows, disparity.cols, CV_8UC3);
  for (int y = 0; y < disparity.rows; ++y) {
    const auto* from = disparity.ptr<float>(y);
    auto* to = out.ptr<cv::Vec3b>(y);
    for (int x = 0; x < disparity.cols; ++x) {
      const double value = 255.0 * static_cast<double>(from[x]) / scale_end;
      to[x] = std::isfinite(from[x]) ? bgr(table[static_cast<int>(std::clamp(value, 0.0, 255.0))])
                                     : bgr(kNoDisparity);
    }
  }
  return out;
}

EncodedPicture encode_disparity(const Image<float>& image, PictureKey key, std::int64_t timestamp_ns) {
  const cv::Mat full(image.height, image.width, CV_32F, const_cast<float*>(image.pixels.data()));
  const cv::Mat sent = fitted(full, key.max_width_px, cv::INTER_NEAREST);
  EncodedPicture picture = described(full, sent, key, timestamp_ns);
  picture.scale_max_px = scale_end_px(image);
  std::vector<std::uint8_t> file;
  cv::imencode(".png", coloured(sent, picture.scale_max_px), file, {cv::IMWRITE_PNG_COMPRESSION, kFastPng});
  picture.media_type = "image/png";
  picture.data = to_string(file);
  return picture;
}

}  // namespace

PictureSize fitted_size(std::int64_t width, std::int64_t height, std::int64_t max_width_px) {
  if (max_width_px <= 0 || width <= max_width_px) return {width, height};
  const double scale = static_cast<double>(max_width_px) / static_cast<double>(width);
  return {max_width_px, std::max<std::int64_t>(1, std::llround(static_cast<double>(height) * scale))};
}

Image<std::uint8_t> shrunk_to_largest(const Image<std::uint8_t>& image, PictureSize size) {
  if (size.width == image.width && size.height == image.height) return image;
  Image<std::uint8_t> small(static_cast<int>(size.width), static_cast<int>(size.height), 0);
  // Pixel i of n covers what lies between i/n and (i+1)/n of the image: columns that two share count in both.
  const auto first = [](std::int64_t i, std::int64_t n, std::int64_t of) { return i * of / n; };
  const auto behind = [](std::int64_t i, std::int64_t n, std::int64_t of) {
    return ((i + 1) * of + n - 1) / n;
  };
  for (int v = 0; v < small.height; ++v) {
    std::uint8_t* out = small.row(v);
    const auto last_row = static_cast<int>(behind(v, small.height, image.height));
    for (auto y = static_cast<int>(first(v, small.height, image.height)); y < last_row; ++y) {
      const std::uint8_t* row = image.row(y);
      for (int u = 0; u < small.width; ++u) {
        const std::uint8_t* end = row + behind(u, small.width, image.width);
        out[u] = std::max(out[u], *std::max_element(row + first(u, small.width, image.width), end));
      }
    }
  }
  return small;
}

PictureKey picture_key(const ImageRequest& request) {
  constexpr std::array kWidths{1280, 960, 640, 480, 320, 240, 160, 120, 80, 40, 20, 10, 5, 2, 1};
  if (request.max_width_px <= 0) return {request.stream, 0};
  const auto width =
      std::find_if(kWidths.begin(), kWidths.end(), [&](int w) { return w <= request.max_width_px; });
  return {request.stream, *width};
}

std::optional<EncodedPicture> encode_picture(const PictureReport& report, PictureKey key) {
  if (key.stream == ImageStream::disparity) {
    if (!report.disparity || report.disparity->px.empty()) return std::nullopt;
    return encode_disparity(report.disparity->px, key, report.timestamp_ns);
  }
  if (!report.frame) return std::nullopt;
  const auto& image = key.stream == ImageStream::left ? report.frame->left : report.frame->right;
  if (image.empty()) return std::nullopt;
  return encode_grey(image, key, report.timestamp_ns);
}

std::string encode_coloured_png(const Image<std::uint8_t>& values, Palette palette) {
  const cv::Mat sent(values.height, values.width, CV_8U, const_cast<std::uint8_t*>(values.pixels.data()));
  cv::Mat picture;
  if (palette == Palette::grey) {
    cv::bitwise_not(sent, picture);  // white free or unknown, black occupied
  } else {
    cv::Mat table(1, 256, CV_8UC3);
    for (int i = 0; i < 256; ++i) {
      const Colour colour = table_of(palette)[i];
      table.at<cv::Vec3b>(i) = {colour.b, colour.g, colour.r};
    }
    cv::cvtColor(sent, picture, cv::COLOR_GRAY2BGR);
    cv::LUT(picture, table, picture);
  }
  std::vector<std::uint8_t> file;
  cv::imencode(".png", picture, file, {cv::IMWRITE_PNG_COMPRESSION, 3});
  return to_string(file);
}

}  // namespace flogmap
