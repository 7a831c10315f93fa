#include "camera/simulation/face_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace flogmap {
namespace {

using Eigen::Vector3d;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr std::size_t kLeafSize = 4;
constexpr std::size_t kMaxDepth = 64;

Eigen::AlignedBox3d bounds_of(const Face& face) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& corner : face.corners_m) box.extend(corner);
  return box;
}

/// Does the ray pass through the box before `reach`? Slabs, after Kay and Kajiya 1986.
bool passes(const Eigen::AlignedBox3d& box, const Vector3d& from, const Vector3d& inverse, double reach) {
  double near = 0, far = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min()[axis] - from[axis]) * inverse[axis];
    const double b = (box.max()[axis] - from[axis]) * inverse[axis];
    near = std::max(near, std::min(a, b));  // a NaN (0 * infinity) leaves `near` as it was
    far = std::min(far, std::max(a, b));
  }
  return near <= far + 1e-9;
}

}  // namespace

FaceTree::FaceTree(const std::vector<Face>& faces) : faces_(faces), order_(faces.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  if (!faces_.empty()) build(0, faces_.size());
}

std::size_t FaceTree::build(std::size_t first, std::size_t last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  for (std::size_t i = first; i < last; ++i) box.extend(bounds_of(faces_[order_[i]]));
  nodes_[index].bounds = box;
  if (last - first <= kLeafSize) {
    nodes_[index].first = first;
    nodes_[index].count = last - first;
    return index;
  }
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = (first + last) / 2;
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                   order_.begin() + static_cast<std::ptrdiff_t>(middle),
                   order_.begin() + static_cast<std::ptrdiff_t>(last), [&](std::size_t a, std::size_t b) {
                     return bounds_of(faces_[a]).center()[axis] < bounds_of(faces_[b]).center()[axis];
                   });
  const std::size_t left = build(first, middle), right = build(middle, last);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

double FaceTree::hit(std::size_t index, const Vector3d& from, const Vector3d& direction) const {
  const Face& face = faces_[index];
  const double towards = face.normal.dot(direction);
  if (std::abs(towards) < 1e-12) return kNever;
  const double distance = face.normal.dot(face.corners_m[0] - from) / towards;
  if (distance <= 0) return kNever;
  const Vector3d p = from + distance * direction;
  for (std::size_t i = 0; i < face.corners_m.size(); ++i) {
    const Vector3d& a = face.corners_m[i];
    const Vector3d& b = face.corners_m[(i + 1) % face.corners_m.size()];
    if (face.normal.dot((b - a).cross(p - a)) < -1e-9 * (b - a).norm()) return kNever;
  }
  return distance;
}

template <typename OnHit>
void FaceTree::walk(const Vector3d& from, const Vector3d& direction, double& reach_m, OnHit on_hit) const {
  if (nodes_.empty()) return;
  const Vector3d inverse = direction.cwiseInverse();
  std::array<std::size_t, kMaxDepth> waiting{};
  std::size_t num_waiting = 1;
  while (num_waiting > 0) {
    const Node& node = nodes_[waiting[--num_waiting]];
    if (!passes(node.bounds, from, inverse, reach_m)) continue;
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      const double distance = hit(order_[i], from, direction);
      if (distance < reach_m && on_hit(distance, order_[i])) return;
    }
    if (node.count == 0) waiting[num_waiting++] = node.left, waiting[num_waiting++] = node.right;
  }
}

std::optional<FaceHit> FaceTree::nearest(const Vector3d& from, const Vector3d& direction,
                                         double reach_m) const {
  std::optional<FaceHit> best;
  walk(from, direction, reach_m, [&](double distance, std::size_t face) {
    best = FaceHit{distance, face};
    reach_m = distance;
    return false;
  });
  return best;
}

bool FaceTree::blocked(const Vector3d& from, const Vector3d& direction, double reach_m) const {
  bool found = false;
  walk(from, direction, reach_m, [&](double, std::size_t) { return found = true; });
  return found;
}

}  // namespace flogmap
