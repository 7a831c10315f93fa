#include "mapping/odometry/ground_plane.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

constexpr int kNumSeeds = 24;  // pieces from which a search starts
constexpr int kLeastPatches = 12;
constexpr double kLeastShare = 0.04;     // of all that face up; a few far pieces are large but tell nothing
constexpr double kNearlyAsLarge = 0.4;   // a lower floor may be this much smaller than the largest
constexpr double kLeastHeight_m = 0.05;  // of the origin above the floor
constexpr double kSameNormal_rad = 0.2;
constexpr double kFloorSpread_m = 0.4;  // of a far floor's pieces along an up that is not exact yet
constexpr double kParallel_rad = 0.06;  // floors of one building
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
    for (const SurfacePatch* seed : seeds()) {
      const auto plane = grow(seed->normal, seed->centre);
      if (plane && plane->num_patches >= kLeastShare * static_cast<double>(level_.size()))
        planes.push_back(*plane);
    }
    if (planes.empty()) return std::nullopt;
    // The one with most pieces tells best which way is up.
    const GroundPlane& surest = *std::max_element(
        planes.begin(), planes.end(),
        [](const GroundPlane& a, const GroundPlane& b) { return a.num_patches < b.num_patches; });
    const GroundPlane* lowest = &surest;
    for (const GroundPlane& plane : planes) {
      // By area: a table close by fills more of the picture than the floor behind it.
      const bool large = plane.area_m2 >= kNearlyAsLarge * surest.area_m2;
      const bool parallel = within(plane.up, surest.up, kParallel_rad);
      if (large && parallel && plane.height_m > lowest->height_m + options_.slab_m) lowest = &plane;
    }
    const auto below = floor_below(*lowest);
    return below ? below : *lowest;
  }

 private:
  /// Pieces spread evenly over the area that faces up.
  [[nodiscard]] std::vector<const SurfacePatch*> seeds() const {
    double total_m2 = 0;
    for (const SurfacePatch* patch : level_) total_m2 += patch->area_m2;
    std::vector<const SurfacePatch*> chosen;
    double passed_m2 = 0;
    for (const SurfacePatch* patch : level_) {
      passed_m2 += patch->area_m2;
      if (passed_m2 * kNumSeeds >= total_m2 * static_cast<double>(chosen.size() + 1)) chosen.push_back(patch);
    }
    return chosen;
  }

  /// What a large plane stands on, if that is in view: farther away and seen by few pieces, so that it is no
  /// plane of its own yet, but level with this one, lower, and large.
  [[nodiscard]] std::optional<GroundPlane> floor_below(const GroundPlane& plane) const {
    std::vector<const SurfacePatch*> pieces;
    for (const SurfacePatch* patch : level_) {
      if (within(patch->normal, plane.up, kSameNormal_rad)) pieces.push_back(patch);
    }
    const auto height = [&](const SurfacePatch* piece) { return -plane.up.dot(piece->centre); };
    std::sort(pieces.begin(), pieces.end(), [&](auto* a, auto* b) { return height(a) > height(b); });
    const double least_count =
        std::max<double>(kLeastPatches, kLeastShare / 2 * static_cast<double>(level_.size()));
    std::size_t last = 0;
    double area_m2 = 0;
    for (std::size_t first = 0; first < pieces.size(); area_m2 -= pieces[first++]->area_m2) {
      for (; last < pieces.size() && height(pieces[first]) - height(pieces[last]) < kFloorSpread_m; ++last) {
        area_m2 += pieces[last]->area_m2;
      }
      const auto middle = height(pieces[(first + last) / 2]);
      if (middle < plane.height_m + kFloorSpread_m) return std::nullopt;
      if (static_cast<double>(last - first) < least_count || area_m2 < kNearlyAsLarge * plane.area_m2)
        continue;
      // The plane above it vouches for the tilt.
      const int vouching = plane.num_patches + static_cast<int>(last - first);
      return refined({plane.up, middle, plane.tilt_sigma_rad, vouching, area_m2});
    }
    return std::nullopt;
  }

  /// Fits to ever better members while the plane keeps looking the same way; else the plane as it was.
  [[nodiscard]] GroundPlane refined(const GroundPlane& rough) const {
    GroundPlane plane = rough;
    for (const double slab : {4.0, 3.0, 2.0, 2.0}) {
      const auto fitted = fit(plane, slab * options_.slab_m);
      if (!fitted || !within(fitted->up, rough.up, kParallel_rad)) return rough;
      plane = *fitted;
    }
    plane.num_patches = rough.num_patches;
    return plane;
  }

  /// From one piece to the whole plane: the mean of like normals first, then fits to ever better members.
  [[nodiscard]] std::optional<GroundPlane> grow(Eigen::Vector3d up, const Eigen::Vector3d& seed) const {
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const SurfacePatch* patch : level_) {
        if (within(patch->normal, up, kSameNormal_rad)) sum += patch->normal;
      }
      up = sum.normalized();
    }
    const Eigen::Vector3d mean_normal = up;
    GroundPlane plane{.up = up, .height_m = -up.dot(seed)};
    for (const double slab : {3.0, 2.0, 1.0, 1.0}) {
      const auto fitted = fit(plane, slab * options_.slab_m);
      if (!fitted) return std::nullopt;
      plane = *fitted;
    }
    // Pieces of several surfaces can lie on one plane by chance; then it does not look where they look.
    const bool true_to_pieces = within(plane.up, mean_normal, kNearlyVertical_rad);
    return true_to_pieces && plane.height_m >= kLeastHeight_m ? std::optional(plane) : std::nullopt;
  }

  /// One step of least squares for (tilt about two axes, height) on the pieces within the slab, their normals
  /// and the walls.
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

std::optional<GroundPlane> find_ground(const std::vector<SurfacePatch>& patches,
                                       const Eigen::Vector3d& expected_up, const GroundOptions& options) {
  return GroundSearch(patches, expected_up, options).best();
}

}  // namespace flogmap
