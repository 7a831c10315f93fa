#include "mapping/flog/grazing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mapping/simd.hpp"

namespace flogmap {
namespace {

constexpr int kReach_px = 3;  // a slope is that to the pixel so far away
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// What the pixels of a row share.
struct Row {
  float f, cx;       // pixels
  float v;           // from the principal point, pixels
  float up_0, up_x;  // of pixel x: the point's height above the camera is (up_0 + x up_x)/d
  float low, high;   // of the layers, from the camera, metres
  float cos2;        // squared cosine of the greatest incidence
};

/// The flatter one of the slopes to two neighbours; 0 where neither has a disparity.
inline float flatter(float before, float here, float after) {
  const float left = here - before, right = after - here;  // NaN where there is no disparity
  const float a = left == left ? left : right;
  const float b = right == right ? right : a;
  const float slope = std::abs(a) < std::abs(b) ? a : b;
  return slope == slope ? slope / static_cast<float>(kReach_px) : 0.0F;
}

/// `above` and `below` are kReach_px away; `here` has as many more numbers at both ends.
FLOGMAP_SIMD_CLONES
void leave_out(const Row& row, const float* above, const float* here, const float* below, int width,
               float* kept) {
  for (int x = 0; x < width; ++x) {
    const float d = here[x];
    const float g_x = flatter(here[x - kReach_px], d, here[x + kReach_px]);
    const float g_y = flatter(above[x], d, below[x]);
    const float u = static_cast<float>(x) - row.cx;
    const float ahead = (d - g_x * u - g_y * row.v) / row.f;
    const float normal2 = g_x * g_x + g_y * g_y + ahead * ahead;
    const float ray2 = (u * u + row.v * row.v) / (row.f * row.f) + 1.0F;
    const float seen = d / row.f;
    const float height = (row.up_0 + static_cast<float>(x) * row.up_x) / d;
    const bool grazing = seen * seen < row.cos2 * normal2 * ray2;
    kept[x] = grazing && height >= row.low && height < row.high ? kNone : d;
  }
}

Row row_of(const StereoCamera& camera, const GridSpec& grid, const SE3& world_from_camera, double cosine,
           int y) {
  const Eigen::RowVector3d up = world_from_camera.linear().row(2) * camera.baseline_m;
  const double z = world_from_camera.translation().z(), v = y - camera.cy_px;
  return {.f = static_cast<float>(camera.focal_px),
          .cx = static_cast<float>(camera.cx_px),
          .v = static_cast<float>(v),
          .up_0 = static_cast<float>(-up.x() * camera.cx_px + up.y() * v + up.z() * camera.focal_px),
          .up_x = static_cast<float>(up.x()),
          .low = static_cast<float>(grid.layer_bounds_m.front() - z),
          .high = static_cast<float>(grid.layer_bounds_m.back() - z),
          .cos2 = static_cast<float>(cosine * cosine)};
}

}  // namespace

DisparityImage without_grazing(const StereoCamera& camera, const GridSpec& grid, const View& view,
                               double max_incidence_deg) {
  if (max_incidence_deg >= 90) return view.disparity;
  const double cosine = std::cos(max_incidence_deg * std::numbers::pi / 180);
  const Image<float>& disparity = view.disparity.px;
  const std::size_t stride = std::size_t(disparity.width) + 2 * kReach_px;
  std::vector<float> framed(stride * (std::size_t(disparity.height) + 2 * kReach_px), kNone);
  const auto row_at = [&](int y) { return framed.data() + std::size_t(y + kReach_px) * stride + kReach_px; };
  for (int y = 0; y < disparity.height; ++y) {
    std::transform(disparity.row(y), disparity.row(y) + disparity.width, row_at(y),
                   [](float d) { return d > 0 ? d : kNone; });
  }
  DisparityImage kept{Image<float>(disparity.width, disparity.height)};
  for (int y = 0; y < disparity.height; ++y) {
    leave_out(row_of(camera, grid, view.world_from_camera, cosine, y), row_at(y - kReach_px), row_at(y),
              row_at(y + kReach_px), disparity.width, kept.px.row(y));
  }
  return kept;
}

}  // namespace flogmap
