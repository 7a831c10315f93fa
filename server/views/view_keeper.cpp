#include "server/views/view_keeper.hpp"

#include <algorithm>

#include "server/views/view_codec.hpp"

namespace flogmap {

void ViewKeeper::begin(const std::vector<SharedView>& views) {
  kept_.clear();
  next_number_ = 0;
  for (const SharedView& view : views) {
    kept_.push_back(view->world_from_camera);
    next_number_ = std::max(next_number_, view->number + 1);
  }
}

SharedView ViewKeeper::keep(const View& view) {
  if (view.left.empty() || !shows_something_new(view.world_from_camera)) return nullptr;
  kept_.push_back(view.world_from_camera);
  return std::make_shared<const StoredView>(pack_view(view, next_number_++));
}

bool ViewKeeper::shows_something_new(const SE3& pose) const {
  return std::ranges::none_of(kept_, [&](const SE3& kept) {
    if ((kept.translation() - pose.translation()).squaredNorm() >= spacing_.distance_m * spacing_.distance_m)
      return false;
    return Eigen::AngleAxisd(kept.rotation().transpose() * pose.rotation()).angle() < spacing_.angle_rad;
  });
}

}  // namespace flogmap
