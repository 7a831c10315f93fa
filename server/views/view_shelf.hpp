// The kept views of a served map, within a budget.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "server/publication.hpp"
#include "server/stored_view.hpp"

namespace flogmap {

/// By number. When the bytes exceed the budget every second view goes: the walkthrough gets coarser
/// everywhere instead of ending somewhere.
class ViewShelf {
 public:
  static constexpr std::size_t kBudgetBytes = std::size_t{192} << 20;
  explicit ViewShelf(std::size_t budget_bytes = kBudgetBytes) : budget_bytes_(budget_bytes) {}

  void add(SharedView view);
  [[nodiscard]] SharedView find(std::int64_t number) const;  // null if there is none
  [[nodiscard]] const std::map<std::int64_t, SharedView>& all() const { return views_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void thin_out();

  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::map<std::int64_t, SharedView> views_;
};

/// Poses of the views, in their order, as the path has them now: after a loop closure they differ from those
/// that the views were taken with. A view that the path does not know keeps its own.
std::vector<SE3> poses_on_path(const std::map<std::int64_t, SharedView>& views,
                               std::span<const TrajectoryEntry> path);

}  // namespace flogmap
