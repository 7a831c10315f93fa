#include "camera/picture_files.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

bool starts_with(const Bytes& bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(),
                    [](char a, auto b) { return static_cast<std::uint8_t>(a) == b; });
}

bool has_near_end(const Bytes& bytes, std::string_view mark) {
  constexpr std::ptrdiff_t kTail = 64;  // some writers pad
  const auto from = bytes.end() - std::min<std::ptrdiff_t>(kTail, std::ssize(bytes));
  return std::search(from, bytes.end(), mark.begin(), mark.end(),
                     [](auto a, char b) { return a == static_cast<std::uint8_t>(b); }) != bytes.end();
}

/// The decoders return half a picture for half a file; the end marks tell.
std::string truncated_kind(const Bytes& bytes) {
  if (starts_with(bytes, "\x89PNG") && !has_near_end(bytes, "IEND")) return "truncated PNG";
  if (starts_with(bytes, "\xFF\xD8") && !has_near_end(bytes, "\xFF\xD9")) return "truncated JPEG";
  return {};
}

cv::Mat decode(const Bytes& bytes) {
  try {
    return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // more pixels than its limit, and the like
    return {};
  }
}

Picture picture_from(const cv::Mat& decoded) {
  cv::Mat image = decoded;
  if (image.channels() == 4) cv::cvtColor(decoded, image, cv::COLOR_BGRA2BGR);
  Picture picture{image.cols, image.rows, image.channels(), image.depth() == CV_16U ? 16 : 8, {}};
  const std::size_t row_bytes = image.cols * image.elemSize();
  picture.bytes.resize(row_bytes * image.rows);
  for (int y = 0; y < image.rows; ++y) {
    std::memcpy(picture.bytes.data() + y * row_bytes, image.ptr(y), row_bytes);
  }
  return picture;
}

}  // namespace

ReadPicture decode_picture(const Bytes& bytes) {
  if (const std::string kind = truncated_kind(bytes); !kind.empty()) return {{}, kind};
  const cv::Mat decoded = decode(bytes);
  const bool usable = !decoded.empty() && (decoded.depth() == CV_8U || decoded.depth() == CV_16U) &&
                      (decoded.channels() == 1 || decoded.channels() == 3 || decoded.channels() == 4);
  if (!usable) return {{}, "not a readable picture (PNG, JPEG or PGM with 8 or 16 bits)"};
  return {picture_from(decoded), {}};
}

ReadPicture read_picture(const fs::path& file) {
  std::error_code unknown;
  if (fs::exists(file, unknown) && !fs::is_regular_file(file, unknown))  // a folder, or a device without end
    return {{}, file.string() + ": not a file"};
  std::ifstream in(file, std::ios::binary);
  if (!in) return {{}, file.string() + ": cannot be opened"};
  const Bytes bytes{std::istreambuf_iterator<char>(in), {}};
  if (bytes.empty()) return {{}, file.string() + ": empty file"};
  ReadPicture result = decode_picture(bytes);
  if (!result.problem.empty()) result.problem = file.string() + ": " + result.problem;
  return result;
}

bool write_picture(const fs::path& file, const Picture& picture) {
  const int depth = picture.bits == 16 ? CV_16U : CV_8U;
  const cv::Mat view(picture.height, picture.width, CV_MAKETYPE(depth, picture.channels),
                     const_cast<std::uint8_t*>(picture.bytes.data()));  // only read
  // Encoded first and written by ourselves: OpenCV's own writers do not notice a full disk.
  Bytes bytes;
  try {
    if (!cv::imencode(file.extension().string(), view, bytes,
                      {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_JPEG_QUALITY, 92}))
      return false;
  } catch (const cv::Exception&) {
    return false;
  }
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  out.close();
  return out.good();
}

}  // namespace flogmap
