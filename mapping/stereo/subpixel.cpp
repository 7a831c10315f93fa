#include "mapping/stereo/subpixel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mapping/simd.hpp"
#include "mapping/stereo/parallel.hpp"

namespace flogmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kRowsPerPiece = 32;
constexpr float kSameSurface_px = 0.75F;  // neighbours that differ by less belong together
constexpr int kWindow = 4;                // px to each side: they share a shift
constexpr float kMostShift_px = 0.5F;     // beyond, the brightness is not linear any more
constexpr float kPlain = 300;             // sum of squared gradients that noise alone may have in a window
constexpr int kBeside = 4;                // px read beside a row, >= kWindow

/// 1 where two answers lie on one surface, else 0; 0 for NaN.
inline float together(float a, float b) { return std::abs(a - b) < kSameSurface_px ? 1.0F : 0.0F; }
/// The first where it lies on the surface of the second, else 0.
inline float if_together(float a, float b) { return std::abs(a - b) < kSameSurface_px ? a : 0.0F; }

/// Mean of those of five values that lie on the surface of the middle one; NaN where that is NaN.
FLOGMAP_SIMD_CLONES
void smooth_row(const std::array<const float*, 5>& from, int width, float* __restrict to) {
  const float *a = from[0], *b = from[1], *c = from[2], *d = from[3], *e = from[4];
  for (int x = 0; x < width; ++x) {
    const float m = c[x];
    const float sum =
        if_together(a[x], m) + if_together(b[x], m) + if_together(d[x], m) + if_together(e[x], m);
    const float count = together(a[x], m) + together(b[x], m) + together(d[x], m) + together(e[x], m);
    to[x] = (m + sum) / (1 + count);
  }
}

/// A row of both pictures, readable kBeside pixels beyond its ends.
struct BrightnessRow {
  const float *left, *right;
};

/// Compares left(x) with right(x - d): a cubic through four pixels of the right picture.
FLOGMAP_SIMD_CLONES
void compare_row(const BrightnessRow& row, const float* disparity, int width, float* __restrict gradient,
                 float* __restrict difference) {
  const float *left = row.left, *right = row.right;
  const auto last = static_cast<float>(width - 1);
  for (int x = 0; x < width; ++x) {
    const float match = static_cast<float>(x) - disparity[x];
    const float inside = match >= 0 ? match <= last ? 1.0F : 0.0F : 0.0F;  // 0 for NaN
    const float at = inside > 0 ? match : 0.0F;
    const int i = static_cast<int>(at);
    const float t = at - static_cast<float>(i);
    const float a = right[i - 1], b = right[i], c = right[i + 1], d = right[i + 2];
    const float c1 = c - a, c2 = 2 * a - 5 * b + 4 * c - d, c3 = 3 * (b - c) + d - a;
    const float value = b + 0.5F * t * (c1 + t * (c2 + t * c3));
    const float slope = 0.5F * (c1 + t * (2 * c2 + 3 * t * c3));
    gradient[x] = inside * (0.5F * slope + 0.25F * (left[x + 1] - left[x - 1]));
    difference[x] = inside * (left[x] - value);
  }
}

/// What is known of a row of pixels.
struct ComparedRow {
  const float *disparity, *gradient, *difference;
};

/// Per pixel of a row the sums of 1, g, e, g^2 and g e over a window, with gradient g and difference e.
/// Readable kBeside pixels beyond its ends, 0 there.
class WindowSums {
 public:
  static constexpr int kCount = 5;

  explicit WindowSums(int width) : length_(width + 2 * kBeside), values_(kCount * length_) {}
  void clear() { std::fill(values_.begin(), values_.end(), 0.0F); }
  [[nodiscard]] float* of(int which) { return values_.data() + which * length_ + kBeside; }

 private:
  std::size_t length_;
  std::vector<float> values_;
};

/// Adds the pixels of a row that lie on the surface that `here` sees in the same column.
FLOGMAP_SIMD_CLONES
void add_row(const ComparedRow& row, const float* here, int width, float* __restrict n, float* __restrict g,
             float* __restrict e, float* __restrict gg, float* __restrict ge) {
  const float *disparity = row.disparity, *gradient = row.gradient, *difference = row.difference;
  for (int x = 0; x < width; ++x) {
    const float weight = together(disparity[x], here[x]);
    const float slope = weight * gradient[x], rest = weight * difference[x];
    n[x] += weight;
    g[x] += slope;
    e[x] += rest;
    gg[x] += slope * slope;
    ge[x] += slope * rest;
  }
}

/// Adds the sums of the pixel k further along the row where that lies on the same surface.
FLOGMAP_SIMD_CLONES
void add_beside(const float* here, int k, int width, const float* from, float* __restrict sum) {
  for (int x = 0; x < width; ++x) sum[x] += together(here[x + k], here[x]) * from[x + k];
}

/// Least squares of e + g shift - offset = 0 over a window.
FLOGMAP_SIMD_CLONES
void shift_row(WindowSums& sums, int width, float least, float* __restrict disparity) {
  const float *n = sums.of(0), *g = sums.of(1), *e = sums.of(2), *gg = sums.of(3), *ge = sums.of(4);
  for (int x = 0; x < width; ++x) {
    const float mean_g = g[x] / (n[x] + 1e-3F);
    const float shift = -(ge[x] - mean_g * e[x]) / (gg[x] - mean_g * g[x] + kPlain);
    const float moved = disparity[x] + std::min(std::max(shift, -kMostShift_px), kMostShift_px);
    disparity[x] = std::max(moved, least);  // NaN stays
  }
}

/// Calls work(first row, end) for pieces of the picture.
template <typename Work>
void for_rows(int num_threads, int height, const Work& work) {
  parallel_for(num_threads, (height + kRowsPerPiece - 1) / kRowsPerPiece, [&](int /*worker*/, int piece) {
    work(piece * kRowsPerPiece, std::min(height, (piece + 1) * kRowsPerPiece));
  });
}

/// A row as float, its ends repeated beside it.
void load_row(const std::uint8_t* from, int width, std::vector<float>& to) {
  to.resize(width + 2 * kBeside);
  std::copy_n(from, width, to.begin() + kBeside);
  std::fill_n(to.begin(), kBeside, from[0]);
  std::fill_n(to.end() - kBeside, kBeside, from[width - 1]);
}

}  // namespace

void SubpixelFit::refine(DisparityImage& disparity, const RectifiedFrame& pair) {
  if (disparity.px.empty()) return;
  for (Image<float>* image : {&along_, &gradient_, &difference_}) {
    if (image->width != disparity.px.width || image->height != disparity.px.height) {
      *image = Image<float>(disparity.px.width, disparity.px.height);
    }
  }
  smooth(disparity.px);
  compare(disparity.px, pair);
  shift(disparity.px);
  smooth(disparity.px);
}

void SubpixelFit::smooth(Image<float>& disparity) {
  const int width = disparity.width, height = disparity.height;
  const std::vector<float> nothing(width, kNone);
  for_rows(num_threads_, height, [&](int begin, int end) {
    std::vector<float> row(width + 2 * kBeside, kNone);
    const float* c = row.data() + kBeside;
    for (int y = begin; y < end; ++y) {
      std::copy_n(disparity.row(y), width, row.begin() + kBeside);
      smooth_row({c - 2, c - 1, c, c + 1, c + 2}, width, along_.row(y));
    }
  });
  for_rows(num_threads_, height, [&](int begin, int end) {
    const auto row = [&](int y) { return y >= 0 && y < height ? along_.row(y) : nothing.data(); };
    for (int y = begin; y < end; ++y) {
      smooth_row({row(y - 2), row(y - 1), row(y), row(y + 1), row(y + 2)}, width, disparity.row(y));
    }
  });
}

void SubpixelFit::compare(const Image<float>& disparity, const RectifiedFrame& pair) {
  const int width = disparity.width;
  for_rows(num_threads_, disparity.height, [&](int begin, int end) {
    std::vector<float> left, right;
    for (int y = begin; y < end; ++y) {
      load_row(pair.left.row(y), width, left);
      load_row(pair.right.row(y), width, right);
      compare_row({left.data() + kBeside, right.data() + kBeside}, disparity.row(y), width, gradient_.row(y),
                  difference_.row(y));
    }
  });
}

void SubpixelFit::shift(Image<float>& disparity) const {
  const Image<float> from = disparity;
  const int width = disparity.width, height = disparity.height;
  for_rows(num_threads_, height, [&](int begin, int end) {
    std::vector<float> here(width + 2 * kBeside, kNone);
    WindowSums column(width), window(width);
    for (int y = begin; y < end; ++y) {
      column.clear();
      window.clear();
      for (int v = std::max(0, y - kWindow); v <= std::min(height - 1, y + kWindow); ++v) {
        add_row({from.row(v), gradient_.row(v), difference_.row(v)}, from.row(y), width, column.of(0),
                column.of(1), column.of(2), column.of(3), column.of(4));
      }
      std::copy_n(from.row(y), width, here.begin() + kBeside);
      for (int which = 0; which < WindowSums::kCount; ++which) {
        for (int k = -kWindow; k <= kWindow; ++k) {
          add_beside(here.data() + kBeside, k, width, column.of(which), window.of(which));
        }
      }
      shift_row(window, width, least_px_, disparity.row(y));
    }
  });
}

}  // namespace flogmap
