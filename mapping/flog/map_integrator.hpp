// Views in, changed tiles out: the map itself.
#pragma once

#include <vector>

#include "mapping/flog/cell_fuse.hpp"
#include "mapping/flog/fan_integrator.hpp"
#include "mapping/flog/flog_options.hpp"
#include "mapping/flog/ray_model.hpp"
#include "mapping/flog/view_evidence.hpp"
#include "mapping/tile_update.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Owns the map. Not to be shared between threads; what it hands out is immutable and may be.
class MapIntegrator {
 public:
  /// max_disparity_px > 0: what the matcher can find; with it the full confidence N_K is derived.
  /// Throws std::invalid_argument for impossible options or an impossible camera.
  MapIntegrator(const FlogOptions& options, const StereoCamera& camera, double max_disparity_px);

  /// Adds a view and returns the tiles that it changed, ordered by index, all with the same new revision.
  /// Nothing comes back, and the revision stays, if no ray of it meets the layers or its pose is not finite.
  /// The same views in the same order give the same bytes, on any number of threads.
  std::vector<TileUpdate> integrate(const View& view);

  [[nodiscard]] const MapInfo& info() const { return map_.info; }
  [[nodiscard]] std::uint64_t revision() const { return map_.revision; }
  [[nodiscard]] MapSnapshot snapshot() const { return map_; }

  /// An empty map of the same kind, at revision 0.
  void reset();

  /// Goes on from a stored map, with that map's N_K and revision. Throws std::runtime_error naming the field
  /// if its cells or layers are not those of the options.
  void restore(const MapSnapshot& stored);

  /// Takes over the cells of a map of the same kind that was built aside, and returns only the tiles whose
  /// cells differ, under one new revision; tiles that the other map lacks become unseen ones.
  std::vector<TileUpdate> replace_by(const MapSnapshot& rebuilt);

 private:
  void gather(const View& view);
  std::vector<TileUpdate> merge();
  [[nodiscard]] std::shared_ptr<const Tile> merged(TileIndex index, std::uint64_t revision) const;
  void derive_mergers();

  FlogOptions options_;
  RayModel model_;
  std::vector<CellMerger> mergers_;  // one per layer
  FanIntegrator fan_;
  std::vector<ViewEvidence> evidence_;  // one per thread
  MapSnapshot map_;
};

}  // namespace flogmap
