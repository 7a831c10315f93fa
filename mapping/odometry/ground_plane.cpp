#include "mapping/odometry/ground_plane.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

constexpr int kNumSeeds = 16;              // pieces from which a search starts
constexpr int kLeastPatches = 12;
constexpr double kNearlyAsLarge = 0.4;     // a lower floor may be this much smaller than the largest
constexpr double kLeastHeight_m = 0.05;    // of the origin above the floor
constexpr double kSameNormal_rad = 0.2;
constexpr double kNearlyVertical_rad = 0.1;

bool within(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double angle_rad) {
  return a.dot(b) >= std::cos(angle_rad);
}

class GroundSearch {
 public:
  GroundSearch(const std::vector<SurfacePatch>& patches, const Eigen::Vector3d& expected_up,
               const GroundOptions& options)
      : patches_(patches), options_(options) {
    for (const SurfacePatch& patch : patches) {
      if (within(patch.normal, expected_up, options.max_tilt_rad)) level_.push_back(&patch);
    }
  }

  [[nodiscard]] std::optional<GroundPlane> best() const {
    std::vector<GroundPlane> planes;
    const std::size_t step = std::max<std::size_t>(1, level_.size() / kNumSeeds);
    double largest_m2 = 0;  // by area: a table close by fills more of the picture than the floor behind it
    for (std::size_t i = 0; i < level_.size(); i += step) {
      const auto plane = grow(level_[i]->normal, level_[i]->centre);
      if (!plane) continue;
      planes.push_back(*plane);
      largest_m2 = std::max(largest_m2, plane->area_m2);
    }
    const GroundPlane* lowest = nullptr;
    for (const GroundPlane& plane : planes) {
      const bool large = plane.area_m2 >= kNearlyAsLarge * largest_m2;
      if (large && (!lowest || plane.height_m > lowest->height_m + options_.slab_m ||
                    (plane.height_m > lowest->height_m - options_.slab_m && plane.area_m2 > lowest->area_m2))) {
        lowest = &plane;
      }
    }
    return lowest ? std::optional(*lowest) : std::nullopt;
  }

 private:
  /// From one piece to the whole plane: the mean of like normals first, then fits to ever better members.
  [[nodiscard]] std::optional<GroundPlane> grow(Eigen::Vector3d up, const Eigen::Vector3d& seed) const {
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const SurfacePatch* patch : level_) {
        if (within(patch->normal, up, kSameNormal_rad)) sum += patch->normal;
      }
      up = sum.normalized();
    }
    GroundPlane plane{.up = up, .height_m = -up.dot(seed)};
    for (const double slab : {3.0, 2.0, 1.0, 1.0}) {
      const auto fitted = fit(plane, slab * options_.slab_m);
      if (!fitted) return std::nullopt;
      plane = *fitted;
    }
    return plane.height_m >= kLeastHeight_m ? std::optional(plane) : std::nullopt;
  }

  /// One step of least squares for (tilt about two axes, height) on the pieces within the slab, their normals and
  /// the walls.
  [[nodiscard]] std::optional<GroundPlane> fit(const GroundPlane& plane, double slab_m) const {
    const Eigen::Vector3d u = plane.up.unitOrthogonal(), v = plane.up.cross(u);
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const auto add = [&](const Eigen::Vector3d& row, double error, double sigma) {
      H += row * row.transpose() / (sigma * sigma);
      b -= row * error / (sigma * sigma);
    };
    int count = 0;
    double area_m2 = 0;
    for (const SurfacePatch* patch : level_) {
      const double gap = plane.up.dot(patch->centre) + plane.height_m;
      const double sigma = std::max(patch->range_sigma_m, 0.25 * options_.slab_m);
      if (std::abs(gap) > slab_m + sigma || !within(patch->normal, plane.up, 2 * kSameNormal_rad)) continue;
      add({u.dot(patch->centre), v.dot(patch->centre), 1}, gap, sigma);
      add({1, 0, 0}, -u.dot(patch->normal), options_.normal_sigma_rad);
      add({0, 1, 0}, -v.dot(patch->normal), options_.normal_sigma_rad);
      ++count;
      area_m2 += patch->area_m2;
    }
    if (count < kLeastPatches) return std::nullopt;
    for (const SurfacePatch& wall : patches_) {
      const double off = plane.up.dot(wall.normal);
      if (!options_.use_walls || std::abs(off) > kNearlyVertical_rad) continue;
      add({u.dot(wall.normal), v.dot(wall.normal), 0}, off, options_.normal_sigma_rad);
    }
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(H);
    const Eigen::Vector3d x = ldlt.solve(b);
    if (!x.allFinite()) return std::nullopt;
    const Eigen::Matrix3d covariance = ldlt.solve(Eigen::Matrix3d::Identity());
    return GroundPlane{(plane.up + x(0) * u + x(1) * v).normalized(), plane.height_m + x(2),
                       std::sqrt(covariance(0, 0) + covariance(1, 1)), count, area_m2};
  }

  const std::vector<SurfacePatch>& patches_;
  const GroundOptions& options_;
  std::vector<const SurfacePatch*> level_;  // that face up, more or less
};

}  // namespace

std::optional<GroundPlane> find_ground(const std::vector<SurfacePatch>& patches, const Eigen::Vector3d& expected_up,
                                       const GroundOptions& options) {
  return GroundSearch(patches, expected_up, options).best();
}

}  // namespace flogmap
