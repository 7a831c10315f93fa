#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "camera/simulation/faces.hpp"

namespace flogmap {

/// Where a ray meets the scene.
struct FaceHit {
  double distance_m = 0;
  std::size_t face = 0;
};

/// Casts rays against faces by a tree of bounding boxes. Exact; slower than the renderer, which it checks and
/// lights.
class FaceTree {
 public:
  explicit FaceTree(const std::vector<Face>& faces);

  /// The nearest face within reach along the unit direction, from whichever side.
  [[nodiscard]] std::optional<FaceHit> nearest(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                               double reach_m) const;
  /// Is anything in the way? Quicker than nearest().
  [[nodiscard]] bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                             double reach_m) const;

 private:
  struct Node {
    Eigen::AlignedBox3d bounds;
    std::size_t first = 0, count = 0;  // of order_, if a leaf
    std::size_t left = 0, right = 0;   // children, if count == 0
  };
  std::size_t build(std::size_t first, std::size_t last);
  [[nodiscard]] double hit(std::size_t face, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& direction) const;
  template <typename OnHit>
  void walk(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double& reach_m,
            OnHit on_hit) const;

  std::vector<Face> faces_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace flogmap
