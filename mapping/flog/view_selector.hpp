// Which views go into the map: only those from a new place or in a new direction. FLOG.md section 4,
// paper 2.2.
#pragma once

#include <optional>

#include "camera/stereo_camera.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct ViewSelectorOptions {
  double translation_cells = 4;  // a view is new from this distance on, in cells; > 0 ...
  double translation_m = 0;      // ... or, if > 0, from this distance on, metres
  double cell_size_m = 0.02;     // of the map
  double rotation_rad = 0;       // or if turned by more than this; 0 = half the horizontal field of view
};

/// Throws std::invalid_argument naming field, value and what is allowed.
void check(const ViewSelectorOptions& options);

/// Compares each pose with the last one that it accepted.
class ViewSelector {
 public:
  ViewSelector(const ViewSelectorOptions& options, const StereoCamera& camera);

  /// True if a view from here shows something new; then it is what later poses are compared with.
  bool accept(const SE3& world_from_camera);

  /// The next pose is accepted whatever it is.
  void reset() { last_.reset(); }

 private:
  double translation_m_;
  double rotation_rad_;
  std::optional<SE3> last_;  // world_from_camera
};

}  // namespace flogmap
