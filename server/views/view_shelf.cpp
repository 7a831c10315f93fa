#include "server/views/view_shelf.hpp"

#include <unordered_map>
#include <utility>

namespace flogmap {

void ViewShelf::add(SharedView view) {
  SharedView& place = views_[view->number];
  if (place) bytes_ -= place->bytes.size();
  bytes_ += view->bytes.size();
  place = std::move(view);
  if (bytes_ > budget_bytes_) thin_out();
}

SharedView ViewShelf::find(std::int64_t number) const {
  const auto found = views_.find(number);
  return found == views_.end() ? nullptr : found->second;
}

/// Odd numbers go first, then those that are not multiples of 4, of 8 ...: what is left is spread evenly.
void ViewShelf::thin_out() {
  const std::size_t before = views_.size();
  for (std::int64_t multiple = 2; views_.size() == before && before > 1 && multiple > 0; multiple *= 2) {
    std::erase_if(views_, [&](const auto& entry) {
      const bool goes = entry.first % multiple != 0;
      if (goes) bytes_ -= entry.second->bytes.size();
      return goes;
    });
  }
}

std::vector<SE3> poses_on_path(const std::map<std::int64_t, SharedView>& views,
                               std::span<const TrajectoryEntry> path) {
  std::vector<SE3> poses;
  std::unordered_multimap<std::int64_t, std::size_t> places;
  for (const auto& [number, view] : views) {
    places.emplace(view->timestamp_ns, poses.size());
    poses.push_back(view->world_from_camera);
  }
  // A recording that was continued has each time twice: the nearer pose is the view's own.
  std::vector<double> away(poses.size(), 1e300);
  const std::vector<SE3> taken = poses;
  for (const TrajectoryEntry& entry : path) {
    const auto [begin, end] = places.equal_range(entry.timestamp_ns);
    for (auto it = begin; it != end; ++it) {
      const std::size_t i = it->second;
      const double distance = (entry.world_from_camera.translation() - taken[i].translation()).norm();
      if (distance >= away[i]) continue;
      away[i] = distance;
      poses[i] = entry.world_from_camera;
    }
  }
  return poses;
}

}  // namespace flogmap
