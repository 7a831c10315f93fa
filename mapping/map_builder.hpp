// Views in, changed tiles out, and the whole map anew when a loop moves what was seen before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/flog/map_integrator.hpp"
#include "mapping/loop/path_correction.hpp"
#include "mapping/loop/view_store.hpp"

namespace flogmap {

struct MapBuilderOptions {
  bool keep_views = true;  // else nothing can be corrected
  /// Older views than fit stay in the map where they then are.
  std::size_t max_view_bytes = std::size_t{400} << 20U;
};

/// Owns the map. Each view is integrated at once where the newest correction puts it; after a correction the
/// views are behind until catch_up() has been called often enough. Then the map is, cell by cell, the one
/// that the same views give from scratch with their corrected poses: law of
/// tests/mapping/map_builder_test.cpp.
///
/// Views of a segment whose place is unknown wait. Not to be shared between threads.
class MapBuilder {
 public:
  MapBuilder(MapIntegrator map, const MapBuilderOptions& options);

  /// `view.world_from_camera`: uncorrected. Its disparity is rounded to 1/64 px first. On return it is the
  /// view as integrated; nothing comes back if it waits.
  std::vector<TileUpdate> add(View& view);

  void correct(PathCorrection correction);

  /// Some view stands elsewhere in the map than the newest correction says.
  [[nodiscard]] bool is_behind() const { return built_with_ != corrected_times_; }

  /// Every view of the map is still kept, so that it can be levelled as a whole.
  [[nodiscard]] bool is_whole() const { return options_.keep_views && !frozen_holds_; }

  /// Builds a map aside, one view at a time; the tiles that differ once it is complete and in place.
  std::vector<TileUpdate> catch_up();

  /// Views that wait for their place.
  [[nodiscard]] std::size_t num_waiting() const { return num_waiting_; }

  /// An empty map of the same kind.
  void reset();

  [[nodiscard]] const MapIntegrator& map() const { return map_; }

 private:
  /// The map being built aside.
  struct Rebuild {
    MapIntegrator map;
    PathCorrection correction;
    std::uint64_t with = 0;  // the number of this correction
    std::size_t next = 0;    // view of the store
  };

  void freeze_oldest();
  void count_waiting();

  MapBuilderOptions options_;
  MapIntegrator map_;
  MapIntegrator frozen_;  // what the store's views are added to: an earlier map, views no longer kept
  bool frozen_holds_ = false;
  ViewStore views_;
  PathCorrection correction_;
  std::uint64_t corrected_times_ = 0;
  std::uint64_t built_with_ = 0;
  std::size_t num_waiting_ = 0;
  std::optional<Rebuild> rebuild_;
};

}  // namespace flogmap
