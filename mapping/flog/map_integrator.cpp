#include "mapping/flog/map_integrator.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "mapping/flog/full_confidence.hpp"
#include "mapping/flog/grazing.hpp"
#include "mapping/flog/ray_integrator.hpp"
#include "mapping/flog/threads.hpp"

namespace flogmap {
namespace {

void check(const StereoCamera& camera, double max_disparity_px) {
  const bool usable =
      camera.focal_px > 0 && camera.baseline_m > 0 && camera.width_px > 0 && camera.height_px > 0;
  if (!usable)
    throw std::invalid_argument("focal_px, baseline_m, width_px and height_px of the camera must be > 0");
  if (!(max_disparity_px > 0)) {
    throw std::invalid_argument("max_disparity_px must be > 0, got " + std::to_string(max_disparity_px));
  }
}

MapInfo map_info(const FlogOptions& options, const StereoCamera& camera, double max_disparity_px) {
  MapInfo info{options.grid, {}, static_cast<std::uint16_t>(options.min_rays)};
  info.full_confidence_rays =
      full_confidence_rays(camera, options.grid, max_disparity_px, options.row_step, options.column_step);
  if (options.full_confidence_rays > 0) {
    const auto N_K = static_cast<float>(std::max(1.0, options.full_confidence_rays));
    std::fill(info.full_confidence_rays.begin(), info.full_confidence_rays.end(), N_K);
  }
  return info;
}

/// Far from here column indices would not fit into 32 bits.
bool within_the_grid(const GridSpec& grid, const SE3& world_from_camera) {
  const double limit_m = grid.cell_size_m * (1 << 29);
  const Eigen::Vector3d T = world_from_camera.translation();
  return world_from_camera.matrix().allFinite() && T.cwiseAbs().maxCoeff() < limit_m;
}

std::shared_ptr<Tile> unseen_tile(const GridSpec& grid) {
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(std::size_t(kTileColumns) * std::size_t(grid.num_layers()));
  return tile;
}

bool same_cells(const std::shared_ptr<const Tile>& a, const std::shared_ptr<const Tile>& b) {
  const auto unseen = [](const Cell& cell) { return cell == Cell{}; };
  if (a && b) return a->cells == b->cells;
  const Tile* only = a ? a.get() : b.get();
  return only == nullptr || std::all_of(only->cells.begin(), only->cells.end(), unseen);
}

}  // namespace

MapIntegrator::MapIntegrator(const FlogOptions& options, const StereoCamera& camera, double max_disparity_px)
    : options_(options), model_(ray_model(options, camera)), fan_(model_, options.grid) {
  check(options);
  check(camera, max_disparity_px);
  map_.info = map_info(options, camera, max_disparity_px);
  derive_mergers();
  evidence_.resize(threads_for(options.num_threads), ViewEvidence(options.grid.num_layers()));
}

void MapIntegrator::derive_mergers() {
  mergers_.clear();
  for (const float N_K : map_.info.full_confidence_rays) mergers_.emplace_back(N_K);
}

std::vector<TileUpdate> MapIntegrator::integrate(const View& view) {
  if (view.disparity.px.size() > kMaxRaysPerView || !within_the_grid(options_.grid, view.world_from_camera)) {
    return {};
  }
  View squarely;
  squarely.world_from_camera = view.world_from_camera;
  squarely.disparity = without_grazing(model_.camera, options_.grid, view,
                                       options_.paper_mode ? 90 : options_.max_incidence_deg);
  gather(squarely);
  return merge();
}

void MapIntegrator::gather(const View& view) {
  const Eigen::Vector3d T = view.world_from_camera.translation();
  const double reach = reach_m(model_) + 2 * options_.grid.cell_size_m;
  for (ViewEvidence& evidence : evidence_) {
    evidence.start(cell_at(options_.grid, T.x() - reach, T.y() - reach),
                   cell_at(options_.grid, T.x() + reach, T.y() + reach));
  }
  if (options_.integrator == IntegratorKind::fan) {
    fan_.integrate(view, evidence_);
  } else {
    integrate_ray_by_ray(model_, options_.grid, view, evidence_.front());
  }
}

std::vector<TileUpdate> MapIntegrator::merge() {
  std::vector<TileIndex> touched;
  for (const ViewEvidence& evidence : evidence_) {
    touched.insert(touched.end(), evidence.touched().begin(), evidence.touched().end());
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const std::uint64_t revision = map_.revision + 1;
  std::vector<TileUpdate> updates;
  for (const TileIndex index : touched) updates.push_back({index, revision, nullptr});
  const int num_threads = static_cast<int>(evidence_.size());
  run_on_threads(num_threads, [&](int thread) {
    for (std::size_t i = thread; i < updates.size(); i += num_threads) {
      updates[i].tile = merged(updates[i].index, revision);
    }
  });
  for (const TileUpdate& update : updates) map_.tiles[update.index] = update.tile;
  if (!updates.empty()) map_.revision = revision;
  return updates;
}

std::shared_ptr<const Tile> MapIntegrator::merged(TileIndex index, std::uint64_t revision) const {
  const auto old = map_.tiles.find(index);
  auto tile = old == map_.tiles.end() ? unseen_tile(options_.grid) : std::make_shared<Tile>(*old->second);
  tile->revision = revision;
  std::vector<const EvidenceSum*> parts;
  for (const ViewEvidence& evidence : evidence_) {
    if (const EvidenceSum* part = evidence.tile(index)) parts.push_back(part);
  }
  const int num_layers = options_.grid.num_layers();
  for (int column = 0, i = 0; column < kTileColumns; ++column) {
    for (int k = 0; k < num_layers; ++k, ++i) {
      EvidenceSum sum;
      for (const EvidenceSum* part : parts) sum += part[i];
      if (sum.empty()) continue;
      const CellEvidence evidence = sum.evidence();
      if (evidence.rays == 0) continue;  // less than half a ray
      mergers_[k].merge(tile->cells[std::size_t(k) * kTileColumns + column], evidence);
    }
  }
  return tile;
}

void MapIntegrator::reset() {
  map_.tiles.clear();
  map_.revision = 0;
}

void MapIntegrator::restore(const MapSnapshot& stored) {
  if (stored.info.grid.cell_size_m != options_.grid.cell_size_m) {
    throw std::runtime_error("stored map: cell_size_m is " + std::to_string(stored.info.grid.cell_size_m) +
                             ", but the options ask for " + std::to_string(options_.grid.cell_size_m));
  }
  if (stored.info.grid.layer_bounds_m != options_.grid.layer_bounds_m) {
    throw std::runtime_error("stored map: layer_bounds_m are not those of the options");
  }
  const auto num_layers = std::size_t(options_.grid.num_layers());
  if (stored.info.full_confidence_rays.size() != num_layers) {
    throw std::runtime_error("stored map: full_confidence_rays must hold one number per layer");
  }
  for (const auto& [index, tile] : stored.tiles) {
    if (tile && tile->cells.size() == num_layers * kTileColumns) continue;
    throw std::runtime_error("stored map: tile " + std::to_string(index.x) + "," + std::to_string(index.y) +
                             " does not hold 4096 cells per layer");
  }
  map_ = stored;
  derive_mergers();
}

std::vector<TileUpdate> MapIntegrator::replace_by(const MapSnapshot& rebuilt) {
  const std::uint64_t revision = map_.revision + 1;
  std::map<TileIndex, std::shared_ptr<const Tile>> tiles = map_.tiles;
  for (auto& [index, tile] : tiles) tile = nullptr;
  for (const auto& [index, tile] : rebuilt.tiles) tiles[index] = tile;
  std::vector<TileUpdate> updates;
  for (auto& [index, tile] : tiles) {
    const auto old = map_.tiles.find(index);
    if (old != map_.tiles.end() && same_cells(old->second, tile)) {
      tile = old->second;
      continue;
    }
    auto changed = tile ? std::make_shared<Tile>(*tile) : unseen_tile(options_.grid);
    changed->revision = revision;
    tile = changed;
    updates.push_back({index, revision, tile});
  }
  map_.tiles = std::move(tiles);
  if (!updates.empty()) map_.revision = revision;
  return updates;
}

}  // namespace flogmap
