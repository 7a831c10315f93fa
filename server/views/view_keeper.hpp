// Which mapped views are kept for the walkthrough.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "server/stored_view.hpp"

namespace flogmap {

struct ViewSpacing {
  double distance_m = 0.15;
  double angle_rad = 10 * std::numbers::pi / 180;
};

/// Keeps a view only if none that is kept was taken from about the same place in about the same direction:
/// what is kept grows with the visited area, not with time. One thread at a time.
class ViewKeeper {
 public:
  explicit ViewKeeper(const ViewSpacing& spacing = {}) : spacing_(spacing) {}

  /// A map begins, with these views if it is continued.
  void begin(const std::vector<SharedView>& views);

  /// The packed view, or null if it shows nothing new.
  SharedView keep(const View& view);

 private:
  [[nodiscard]] bool shows_something_new(const SE3& world_from_camera) const;

  ViewSpacing spacing_;
  std::vector<SE3> kept_;
  std::int64_t next_number_ = 0;
};

}  // namespace flogmap
