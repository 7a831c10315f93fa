#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
  /// A loop closed, or somebody levelled the map: the whole path so far as it now is, frames that had no
  /// place before included. The tiles follow when the map has been built anew. `reason`: in words, for
  /// viewers.
  virtual void path_rewritten(const std::vector<TrajectoryEntry>& /*path*/, const std::string& /*reason*/) {}
  virtual void map_levelled(const HandLevel& /*level*/) {}  // its tiles have just been told by map_changed()
  virtual void frame_tracked(const TrackingReport& report) = 0;
  virtual void pictures_taken(const PictureReport& report) = 0;
  virtual void status_changed(const StatusReport& report) = 0;
};

}  // namespace flogmap
