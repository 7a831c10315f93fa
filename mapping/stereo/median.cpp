#include "mapping/stereo/median.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "mapping/stereo/parallel.hpp"

namespace flogmap {
namespace {

constexpr int kRowsPerPiece = 32;

inline void sort2(float& a, float& b) {
  const float low = a < b ? a : b;
  b = a < b ? b : a;
  a = low;
}

/// The least, middle and greatest of three.
inline void sort3(float& a, float& b, float& c) {
  sort2(a, b);
  sort2(b, c);
  sort2(a, b);
}

inline float max_of(float a, float b) { return a > b ? a : b; }
inline float min_of(float a, float b) { return a < b ? a : b; }

/// Median of nine: of the greatest minimum, the median of the middles and the least maximum of three columns.
inline float median9(float a, float b, float c, float d, float e, float f, float g, float h, float i) {
  sort3(a, b, c);
  sort3(d, e, f);
  sort3(g, h, i);
  float low = max_of(max_of(a, d), g), high = min_of(min_of(c, f), i);
  sort3(b, e, h);
  sort3(low, e, high);
  return e;
}

/// Rows have a NaN on either side. `from(NaN)` compares false, so an invalid neighbour gives `centre`.
void median_row(const float* above, const float* here, const float* below, int width, float* to) {
  const auto or_centre = [](float value, float centre) { return value == value ? value : centre; };
  for (int x = 0; x < width; ++x) {
    const float c = here[x];
    to[x] = median9(or_centre(above[x - 1], c), or_centre(above[x], c), or_centre(above[x + 1], c),
                    or_centre(here[x - 1], c), c, or_centre(here[x + 1], c), or_centre(below[x - 1], c),
                    or_centre(below[x], c), or_centre(below[x + 1], c));
  }
}

/// A copy with a border of NaN.
Image<float> bordered(const Image<float>& image) {
  Image<float> out(image.width + 2, image.height + 2, std::numeric_limits<float>::quiet_NaN());
  for (int y = 0; y < image.height; ++y) {
    std::copy(image.row(y), image.row(y) + image.width, out.row(y + 1) + 1);
  }
  return out;
}

}  // namespace

void median_3x3(DisparityImage& disparity, int num_threads) {
  const Image<float> from = bordered(disparity.px);
  const int height = disparity.px.height, num_pieces = (height + kRowsPerPiece - 1) / kRowsPerPiece;
  parallel_for(num_threads, num_pieces, [&](int /*worker*/, int piece) {
    for (int y = piece * kRowsPerPiece; y < std::min(height, (piece + 1) * kRowsPerPiece); ++y) {
      median_row(from.row(y) + 1, from.row(y + 1) + 1, from.row(y + 2) + 1, disparity.px.width,
                 disparity.px.row(y));
    }
  });
}

}  // namespace flogmap
