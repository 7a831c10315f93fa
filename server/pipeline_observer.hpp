#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/path_rewrite.hpp"
#include "server/publication.hpp"

namespace flogmap {

/// Who hears what the pipeline finds: the hub and the store of `serve`, the files of `map`. Calls come from
/// the vision and the map thread and must return soon.
class PipelineObserver {
 public:
  virtual ~PipelineObserver() = default;
  virtual void map_begins(const MapBegin& begin) = 0;  // before anything else of that map, path included
  virtual void map_changed(std::uint64_t revision, const std::vector<TileUpdate>& updates) = 0;
  virtual void view_mapped(const View& /*view*/) {}  // its cells have just been told by map_changed()
  virtual void path_grew(const std::vector<TrajectoryEntry>& entries) = 0;
  /// The tiles are still those of the path before, until map_caught_up().
  virtual void path_rewritten(const PathRewrite& /*rewrite*/) {}
  /// The map has been built anew for the path of this number; its tiles have just been told by map_changed().
  virtual void map_caught_up(std::uint64_t /*number*/) {}
  virtual void frame_tracked(const TrackingReport& report) = 0;
  virtual void pictures_taken(const PictureReport& report) = 0;
  virtual void status_changed(const StatusReport& report) = 0;
};

}  // namespace flogmap
