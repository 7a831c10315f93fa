#include "mapping/stereo/census.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "mapping/stereo/parallel.hpp"

namespace flogmap {
namespace {

constexpr int kWindowRows = 2 * kCensusReachPx + 1;
constexpr int kRowsPerPiece = 32;

/// The rows around row y, with replicated borders and slack for whole registers.
class PaddedRows {
 public:
  explicit PaddedRows(int width) : width_(width), row_size_(width + 2 * kCensusReachPx + kMaxLanes) {
    bytes_.resize(static_cast<std::size_t>(row_size_) * kWindowRows);
  }

  std::array<const std::uint8_t*, kWindowRows> around(const Image<std::uint8_t>& image, int y) {
    std::array<const std::uint8_t*, kWindowRows> rows{};
    for (int i = 0; i < kWindowRows; ++i) {
      const int source = std::clamp(y + i - kCensusReachPx, 0, image.height - 1);
      rows[i] = padded(image.row(source), i);
    }
    return rows;
  }

 private:
  const std::uint8_t* padded(const std::uint8_t* from, int slot) {
    std::uint8_t* to = bytes_.data() + static_cast<std::size_t>(slot) * row_size_;
    std::memset(to, from[0], kCensusReachPx);
    std::memcpy(to + kCensusReachPx, from, static_cast<std::size_t>(width_));
    std::memset(to + kCensusReachPx + width_, from[width_ - 1], row_size_ - kCensusReachPx - width_);
    return to + kCensusReachPx;
  }

  int width_;
  int row_size_;
  std::vector<std::uint8_t> bytes_;
};

/// to[i] = from[W-1-i - min_disparity], clamped to the row.
void reverse(const std::uint8_t* from, int width, int min_disparity, std::uint8_t* to, int size) {
  const int first = std::clamp(-min_disparity, 0, size);            // entries before: right of the row
  const int last = std::clamp(width - min_disparity, first, size);  // entries from here on: left of it
  std::memset(to, from[width - 1], static_cast<std::size_t>(first));
  for (int i = first; i < last; ++i) to[i] = from[width - 1 - i - min_disparity];
  std::memset(to + last, from[0], static_cast<std::size_t>(size - last));
}

}  // namespace

CensusRow CensusPair::row(const std::vector<std::uint8_t>& planes, int width, int y) {
  CensusRow out{};
  for (int i = 0; i < kCensusPlanes; ++i) {
    out.plane[i] = planes.data() + (static_cast<std::size_t>(y) * kCensusPlanes + i) * width;
  }
  return out;
}

void CensusPair::compute(const RectifiedFrame& pair, int min_disparity, const MatchKernels& kernels,
                         int num_threads) {
  const int width = pair.left.width, height = pair.left.height;
  left_width_ = width + kMaxLanes;
  right_width_ = width + kernels.stride;
  left_.resize(static_cast<std::size_t>(left_width_) * kCensusPlanes * height);
  right_.resize(static_cast<std::size_t>(right_width_) * kCensusPlanes * height);
  const int num_pieces = (height + kRowsPerPiece - 1) / kRowsPerPiece;
  parallel_for(num_threads, num_pieces, [&](int /*worker*/, int piece) {
    PaddedRows padded(width);
    std::vector<std::uint8_t> forward(static_cast<std::size_t>(left_width_) * kCensusPlanes);
    std::uint8_t* planes[kCensusPlanes];
    for (int y = piece * kRowsPerPiece; y < std::min(height, (piece + 1) * kRowsPerPiece); ++y) {
      std::uint8_t* left = left_.data() + static_cast<std::size_t>(y) * kCensusPlanes * left_width_;
      for (int i = 0; i < kCensusPlanes; ++i) planes[i] = left + i * left_width_;
      kernels.census_row(padded.around(pair.left, y).data(), width, planes);
      for (int i = 0; i < kCensusPlanes; ++i) planes[i] = forward.data() + i * left_width_;
      kernels.census_row(padded.around(pair.right, y).data(), width, planes);
      std::uint8_t* right = right_.data() + static_cast<std::size_t>(y) * kCensusPlanes * right_width_;
      for (int i = 0; i < kCensusPlanes; ++i) {
        reverse(planes[i], width, min_disparity, right + i * right_width_, right_width_);
      }
    }
  });
}

}  // namespace flogmap
