#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mapping/view.hpp"

namespace flogmap {

/// A mapped view as it is kept for loop closure and meshes. What `bytes` mean is the business of whoever
/// wrote them and is told by `codec`; the store only keeps them whole.
struct StoredView {
  std::int64_t number = 0;  // of the view in its map, from 0
  std::int64_t timestamp_ns = 0;
  SE3 world_from_camera = SE3::Identity();
  int codec = 1;
  std::vector<std::uint8_t> bytes;
};

/// Several threads look at one view; nobody changes it.
using SharedView = std::shared_ptr<const StoredView>;

}  // namespace flogmap
