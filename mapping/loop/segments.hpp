// Which stretches of the path are known to belong together.
#pragma once

#include <map>

namespace flogmap {

/// A segment is a stretch of the path that odometry followed without a loss. Number 0 has a place in the map;
/// another one gets it by being joined, directly or not, with 0.
class Segments {
 public:
  void join(int a, int b) {
    const int root_a = root(a), root_b = root(b);
    if (root_a < root_b) parent_[root_b] = root_a;
    if (root_b < root_a) parent_[root_a] = root_b;
  }
  [[nodiscard]] bool together(int a, int b) const { return root(a) == root(b); }
  [[nodiscard]] bool has_place(int segment) const { return root(segment) == 0; }

 private:
  [[nodiscard]] int root(int segment) const {
    for (auto parent = parent_.find(segment); parent != parent_.end(); parent = parent_.find(segment)) {
      segment = parent->second;
    }
    return segment;
  }

  std::map<int, int> parent_;  // of those that were joined with a smaller one
};

}  // namespace flogmap
