#include "mapping/flog/fan_rays.hpp"

#include <algorithm>
#include <barrier>
#include <utility>

#include "mapping/flog/threads.hpp"
#include "mapping/simd.hpp"

namespace flogmap {
namespace {

constexpr std::uint16_t kNoRay = 0xFFFF;

/// A row of pixels as directions per unit of depth: forward = forward_0 + x * forward_x and so on, where
/// forward is along the heading, left across it, and up is up.
struct PixelRow {
  float forward_0, forward_x, left_0, left_x, up_0, up_x;
  float across_0, across_x, down;  // the same direction in the camera: ((x - cx)/f, (y - cy)/f, 1)
};

/// What every row of a view shares, in single precision.
struct RowConstants {
  float ft;                           // f t: depth = ft / disparity
  float error_per_m2, least_width_m;  // RangeError
  float max_range_m;
  float per_tangent, middle, per_sector;  // AzimuthBins
  bool paper_mode;
};

/// Bins of the pixels of a row, and where in their bins; kNoRay where the disparity is not a positive number.
FLOGMAP_SIMD_CLONES
void find_bins(const PixelRow& row, const RowConstants& k, const float* disparity_px, int step, int count,
               std::uint16_t* bin, std::uint8_t* part) {
  for (int i = 0; i < count; ++i) {
    const float x = static_cast<float>(i);
    const float forward = row.forward_0 + x * row.forward_x;
    const float left = row.left_0 + x * row.left_x;
    const float length = std::abs(forward), width = std::abs(left);
    const bool along = length >= width;
    const float main = along ? forward : left;
    const float side = along ? left : -forward;
    const float tangent = main != 0 ? side / main : 0.0F;
    const float place = tangent * k.per_tangent + k.middle + 0.5F;
    const float quarter = along ? (main < 0 ? 2.0F : 0.0F) : (main < 0 ? 3.0F : 1.0F);
    const int number = static_cast<int>(place) + static_cast<int>(quarter * k.per_sector);
    const float d = disparity_px[i * step];
    bin[i] = static_cast<std::uint16_t>(d > 1e-6F && d < 1e9F ? number : int{kNoRay});
    part[i] = static_cast<std::uint8_t>((place - static_cast<float>(static_cast<int>(place))) * 256.0F);
  }
}

/// The rays of a row, seen from above. Where there is no disparity the numbers mean nothing.
FLOGMAP_SIMD_CLONES
void see_from_above(const PixelRow& row, const RowConstants& k, const float* disparity_px, int step,
                    int count, float* hit_m, float* width_m, float* run_per_rise, float* end_m) {
  for (int i = 0; i < count; ++i) {
    const float x = static_cast<float>(i);
    const float forward = row.forward_0 + x * row.forward_x;
    const float left = row.left_0 + x * row.left_x;
    const float up = row.up_0 + x * row.up_x;
    const float across = row.across_0 + x * row.across_x;
    const float length2 = across * across + row.down * row.down + 1.0F;
    // A vertical ray has no azimuth and no rho: let it lean by a thousandth.
    const float flat2 = std::max(forward * forward + left * left, 1e-6F * length2);
    const float length = std::sqrt(length2), flat = std::sqrt(flat2);
    const float Z = k.ft / disparity_px[i * step];
    const float l = Z * length;
    const float m = std::max(3.0F * k.error_per_m2 * l * (k.paper_mode ? l : Z), k.least_width_m);
    const float cosine = flat / length;
    const float end = l <= k.max_range_m ? l + m : std::min(k.max_range_m, l - m);
    hit_m[i] = Z * flat;
    width_m[i] = std::max(m * cosine, 1e-5F);
    run_per_rise[i] = flat / (up < 0 ? std::min(up, -1e-6F) : std::max(up, 1e-6F));
    end_m[i] = end * cosine;
  }
}

/// Directions of row y, for every column_step-th pixel.
PixelRow pixel_row(const RayModel& model, const SE3& world_from_camera, const Eigen::Vector2d& heading,
                   int y) {
  const double f = model.camera.focal_px;
  const double across_0 = -model.camera.cx_px / f, across_x = model.column_step / f;
  const double down = (y - model.camera.cy_px) / f;
  Eigen::Matrix3d fan_from_world = Eigen::Matrix3d::Identity();
  fan_from_world.row(0).head<2>() = heading;
  fan_from_world.row(1).head<2>() = AzimuthBins::left_of(heading);
  const Eigen::Matrix3d fan_from_camera = fan_from_world * world_from_camera.linear();
  const Eigen::Vector3f first = (fan_from_camera * Eigen::Vector3d(across_0, down, 1)).cast<float>();
  const Eigen::Vector3f step = (fan_from_camera.col(0) * across_x).cast<float>();
  return {first.x(),
          step.x(),
          first.y(),
          step.y(),
          first.z(),
          step.z(),
          static_cast<float>(across_0),
          static_cast<float>(across_x),
          static_cast<float>(down)};
}

RowConstants row_constants(const RayModel& model, const AzimuthBins& bins) {
  return {static_cast<float>(model.camera.focal_px * model.camera.baseline_m),
          static_cast<float>(model.error.per_m2),
          static_cast<float>(model.error.least_width_m),
          static_cast<float>(model.max_range_m),
          static_cast<float>(bins.per_tangent),
          static_cast<float>(bins.middle),
          static_cast<float>(bins.per_sector),
          model.error.paper_mode};
}

}  // namespace

/// Rays of one row, by columns of numbers.
struct FanRays::RowRays {
  std::vector<float> hit_m, width_m, run_per_rise, end_m;
  std::vector<std::uint16_t> bin;  // kNoRay where there is none

  explicit RowRays(int count) : hit_m(count), width_m(count), run_per_rise(count), end_m(count), bin(count) {}
};

AzimuthSpread FanRays::spread(int bin) const {
  const AzimuthRange& range = range_.front()[bin];
  // Less than this much is rounding: all rays of the bin lie on one line, as those of a level camera do.
  constexpr int kOneLine = 4;
  constexpr double kPart = 1.0 / 256;
  const double first = range.least * kPart - 0.5, last = (range.greatest + 1) * kPart - 0.5;
  AzimuthSpread spread = bins_.spread(bin, first, last);
  if (range.greatest - range.least <= kOneLine) spread.half_tangent = 0;
  return spread;
}

void FanRays::start_bins() {
  std::uint32_t next = 0;
  for (int bin = 0; bin < bins_.count(); ++bin) {
    begin_[bin] = next;
    for (auto& counts : place_) next += std::exchange(counts[bin], next);
  }
  begin_.back() = next;
  for (std::size_t thread = 1; thread < range_.size(); ++thread) {
    for (int bin = 0; bin < bins_.count(); ++bin) {
      range_.front()[bin].join(range_[thread][bin]);
    }
  }
  if (rays_.size() < next) rays_.resize(next);
}

void FanRays::count_rays(int thread, const std::uint16_t* bin, const std::uint8_t* part, int count) {
  std::vector<std::uint32_t>& counts = place_[thread];
  std::vector<AzimuthRange>& ranges = range_[thread];
  for (int i = 0; i < count; ++i) {
    if (bin[i] == kNoRay) continue;
    ++counts[bin[i]];
    ranges[bin[i]].join({part[i], part[i]});
  }
}

void FanRays::place_rays(int thread, const std::uint16_t* bin, const RowRays& rays, int count) {
  std::vector<std::uint32_t>& place = place_[thread];
  for (int i = 0; i < count; ++i) {
    if (bin[i] == kNoRay) continue;
    rays_[place[bin[i]]++] = {rays.hit_m[i], rays.width_m[i], rays.run_per_rise[i], rays.end_m[i]};
  }
}

void FanRays::sort(const RayModel& model, const View& view, int num_threads) {
  const Image<float>& d = view.disparity.px;
  bins_ = azimuth_bins(model, view.world_from_camera);
  const RowConstants constants = row_constants(model, bins_);
  const int num_rows = (d.height + model.row_step - 1) / model.row_step;
  const int num_columns = (d.width + model.column_step - 1) / model.column_step;
  place_.assign(num_threads, std::vector<std::uint32_t>(bins_.count(), 0));
  range_.assign(num_threads, std::vector<AzimuthRange>(bins_.count()));
  begin_.assign(bins_.count() + 1, 0);
  std::vector<std::uint16_t> bin_of(std::size_t(num_rows) * num_columns);
  const auto row_at = [&](int row) {
    return pixel_row(model, view.world_from_camera, bins_.heading, row * model.row_step);
  };
  const auto disparities = [&](int row) { return d.row(row * model.row_step); };
  std::barrier counted(num_threads, [this]() noexcept { start_bins(); });
  run_on_threads(num_threads, [&](int thread) {
    const int first = num_rows * thread / num_threads, last = num_rows * (thread + 1) / num_threads;
    std::vector<std::uint8_t> part(num_columns);
    for (int row = first; row < last; ++row) {
      std::uint16_t* bin = bin_of.data() + std::size_t(row) * num_columns;
      find_bins(row_at(row), constants, disparities(row), model.column_step, num_columns, bin, part.data());
      count_rays(thread, bin, part.data(), num_columns);
    }
    counted.arrive_and_wait();
    RowRays rays(num_columns);
    for (int row = first; row < last; ++row) {
      see_from_above(row_at(row), constants, disparities(row), model.column_step, num_columns,
                     rays.hit_m.data(), rays.width_m.data(), rays.run_per_rise.data(), rays.end_m.data());
      place_rays(thread, bin_of.data() + std::size_t(row) * num_columns, rays, num_columns);
    }
  });
}

}  // namespace flogmap
