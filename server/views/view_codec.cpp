#include "server/views/view_codec.hpp"

#include <libdeflate.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace flogmap {
namespace {

constexpr int kCompression = 3;
constexpr int kJpegQuality = 82;
constexpr int kMaxPictureWidth = 1024;
constexpr int kMaxSide = 1 << 14;
constexpr double kSamples = 100'000;  // about so many are kept
constexpr float kUnitsPerPx = 64;
constexpr std::uint16_t kNoMatch = 0;

// Header: width, height, step, bytes of the packed disparities; each 32 bits, lowest byte first.
constexpr std::size_t kHeaderWords = 4;
constexpr std::size_t kHeaderBytes = 4 * kHeaderWords;
using Header = std::array<std::uint32_t, kHeaderWords>;
using Bytes8 = std::vector<std::uint8_t>;

struct Free {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

constexpr int samples_along(int length, int step) { return (length + step - 1) / step; }

int step_of(int width, int height) {
  return std::max(1, static_cast<int>(std::lround(std::sqrt(width * double(height) / kSamples))));
}

std::uint16_t quantised(float disparity_px) {
  if (!(disparity_px > 0)) return kNoMatch;
  const float units = std::round(disparity_px * kUnitsPerPx);
  return units < 1 || units > 65535 ? kNoMatch : static_cast<std::uint16_t>(units);
}

/// Differences along the row, low bytes before high bytes: what is smooth becomes small numbers.
Bytes8 plain_bytes(const Image<float>& disparity, int step) {
  const int columns = samples_along(disparity.width, step), rows = samples_along(disparity.height, step);
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  Bytes8 bytes(2 * count);
  std::size_t at = 0;
  for (int j = 0; j < rows; ++j) {
    std::uint16_t before = 0;
    for (int i = 0; i < columns; ++i, ++at) {
      const std::uint16_t now = quantised(disparity.at(i * step, j * step));
      const auto difference = static_cast<std::uint16_t>(now - before);
      bytes[at] = static_cast<std::uint8_t>(difference & 0xff);
      bytes[count + at] = static_cast<std::uint8_t>(difference >> 8);
      before = now;
    }
  }
  return bytes;
}

Image<float> from_plain_bytes(const Bytes8& bytes, int columns, int rows) {
  Image<float> disparity(columns, rows);
  const std::size_t count = bytes.size() / 2;
  std::size_t at = 0;
  for (int j = 0; j < rows; ++j) {
    std::uint16_t value = 0;
    for (int i = 0; i < columns; ++i, ++at) {
      value = static_cast<std::uint16_t>(value + bytes[at] + (bytes[count + at] << 8));
      disparity.at(i, j) =
          value == kNoMatch ? std::numeric_limits<float>::quiet_NaN() : float(value) / kUnitsPerPx;
    }
  }
  return disparity;
}

Bytes8 deflated(const Bytes8& plain) {
  const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(kCompression));
  if (!compressor) throw std::bad_alloc();
  Bytes8 packed(libdeflate_zlib_compress_bound(compressor.get(), plain.size()));
  packed.resize(
      libdeflate_zlib_compress(compressor.get(), plain.data(), plain.size(), packed.data(), packed.size()));
  return packed;
}

std::optional<Bytes8> inflated(std::span<const std::uint8_t> packed, std::size_t size) {
  const std::unique_ptr<libdeflate_decompressor, Free> decompressor(libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  Bytes8 plain(size);
  const auto result = libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(),
                                                 plain.data(), plain.size(), nullptr);
  if (result != LIBDEFLATE_SUCCESS) return std::nullopt;
  return plain;
}

Bytes8 jpeg_of(const Image<std::uint8_t>& picture) {
  const cv::Mat full(picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.pixels.data()));
  cv::Mat sent = full;
  if (full.cols > kMaxPictureWidth) {
    const double scale = kMaxPictureWidth / double(full.cols);
    cv::resize(full, sent, cv::Size(), scale, scale, cv::INTER_AREA);
  }
  Bytes8 file;
  cv::imencode(".jpg", sent, file, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return file;
}

void put(Bytes8& bytes, const Header& header) {
  for (const std::uint32_t word : header) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  }
}

Header header_of(std::span<const std::uint8_t> bytes) {
  Header header{};
  for (std::size_t i = 0; i < kHeaderBytes; ++i) header[i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
  return header;
}

bool possible(const Header& header, std::size_t size) {
  const auto [width, height, step, packed] = header;
  return width > 0 && width <= kMaxSide && height > 0 && height <= kMaxSide && step > 0 && step <= kMaxSide &&
         packed <= size - kHeaderBytes;
}

}  // namespace

StoredView pack_view(const View& view, std::int64_t number) {
  const Image<float>& disparity = view.disparity.px;
  const bool same = disparity.width == view.left.width && disparity.height == view.left.height;
  if (!same || disparity.width <= 0 || disparity.height <= 0) {
    throw std::invalid_argument("a view needs a picture and a disparity of one size");
  }
  const int step = step_of(disparity.width, disparity.height);
  const Bytes8 packed = deflated(plain_bytes(disparity, step));
  const Bytes8 jpeg = jpeg_of(view.left);
  StoredView stored{number, view.timestamp_ns, view.world_from_camera, kMeshViewCodec, {}};
  stored.bytes.reserve(kHeaderBytes + packed.size() + jpeg.size());
  put(stored.bytes,
      {static_cast<std::uint32_t>(disparity.width), static_cast<std::uint32_t>(disparity.height),
       static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(packed.size())});
  stored.bytes.insert(stored.bytes.end(), packed.begin(), packed.end());
  stored.bytes.insert(stored.bytes.end(), jpeg.begin(), jpeg.end());
  return stored;
}

std::optional<UnpackedView> unpack_view(const StoredView& view) {
  const std::span<const std::uint8_t> bytes(view.bytes);
  if (view.codec != kMeshViewCodec || bytes.size() < kHeaderBytes) return std::nullopt;
  const Header header = header_of(bytes);
  if (!possible(header, bytes.size())) return std::nullopt;
  UnpackedView unpacked;
  unpacked.width_px = static_cast<int>(header[0]);
  unpacked.height_px = static_cast<int>(header[1]);
  unpacked.step = static_cast<int>(header[2]);
  const int columns = samples_along(unpacked.width_px, unpacked.step);
  const int rows = samples_along(unpacked.height_px, unpacked.step);
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const auto plain = inflated(bytes.subspan(kHeaderBytes, header[3]), 2 * count);
  if (!plain) return std::nullopt;
  unpacked.disparity_px = from_plain_bytes(*plain, columns, rows);
  const auto jpeg = bytes.subspan(kHeaderBytes + header[3]);
  unpacked.jpeg.assign(jpeg.begin(), jpeg.end());
  return unpacked;
}

}  // namespace flogmap
