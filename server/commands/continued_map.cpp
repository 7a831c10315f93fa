#include "server/commands/continued_map.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <stdexcept>

#include "mapping/flog/map_integrator.hpp"
#include "server/log.hpp"
#include "server/views/view_codec.hpp"
#include "server/views/view_shelf.hpp"

namespace flogmap {
namespace {

/// Every pixel has the disparity of the nearest sample: as many rays as when the view was mapped.
DisparityImage disparity_of(const UnpackedView& view) {
  DisparityImage disparity{Image<float>(view.width_px, view.height_px)};
  const Image<float>& samples = view.disparity_px;
  for (int y = 0; y < view.height_px; ++y) {
    const int row = std::min((y + view.step / 2) / view.step, samples.height - 1);
    for (int x = 0; x < view.width_px; ++x) {
      disparity.px.at(x, y) = samples.at(std::min((x + view.step / 2) / view.step, samples.width - 1), row);
    }
  }
  return disparity;
}

bool is_of(const StereoCamera& camera, const UnpackedView& view) {
  return view.width_px == camera.width_px && view.height_px == camera.height_px;
}

/// After a kill, viewers may have seen more than was stored: a second, or, where the disk was full, all since
/// the start. A revision far above all that they can know makes them take every tile anew. The clock's
/// milliseconds are above those of any earlier start, stored or not.
void outrank_what_viewers_know(StoredMap& map) {
  constexpr std::uint64_t kFarAbove = 1'000'000;
  const auto now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  map.revision = std::max(map.revision + kFarAbove, static_cast<std::uint64_t>(now_ms.count()));
  for (TileUpdate& update : map.tiles) {
    update.tile = std::make_shared<const Tile>(Tile{update.tile->cells, map.revision});
    update.revision = map.revision;
  }
}

/// Stored now, while nothing is mapped: later it would hold up the tiles of the last second. A disk that
/// refuses it does not keep anybody from mapping; the store's writer tries again and says so.
void store_now(MapStore& store, const StoredMap& map) {
  try {
    store.begin(map);
    store.commit();
  } catch (const std::runtime_error&) {
    store.rollback();
  }
}

/// How many rays a cell needs to count as seen, or as surely known, is a rule over what is stored and may
/// change with every start. True if it has; what viewers keep was made by the old one.
bool follow_options(MapInfo& info, const FlogOptions& flog) {
  const MapInfo before = info;
  info.min_rays = static_cast<std::uint16_t>(flog.min_rays);
  if (flog.full_confidence_rays > 0) {
    for (float& N_K : info.full_confidence_rays) N_K = static_cast<float>(flog.full_confidence_rays);
  }
  return info != before;
}

void let_tiles_follow_path(StoredMap& map, const FlogOptions& flog, const std::filesystem::path& file) {
  map.behind = false;
  log_event(LogLevel::warning, "the stored map is built anew: its path was corrected just before the end",
            {{"file", file.string()}, {"views", static_cast<std::int64_t>(map.views.size())}});
  if (rebuild_from_views(map, flog) > 0) return;
  log_event(LogLevel::warning, "no view of it was kept: its walls stay where they were before the correction",
            {{"file", file.string()}});
}

}  // namespace

int rebuild_from_views(StoredMap& map, const FlogOptions& flog) {
  std::map<std::int64_t, SharedView> views;
  for (const SharedView& view : map.views) views[view->number] = view;
  const std::vector<SE3> poses = poses_on_path(views, map.trajectory);
  const double any_disparity_px = map.camera.width_px;  // N_K is the stored map's
  MapIntegrator now(flog, map.camera, any_disparity_px), rebuilt(flog, map.camera, any_disparity_px);
  now.restore(snapshot_of(map));
  rebuilt.restore({map.info, map.revision, {}});
  int num_views = 0;
  auto pose = poses.begin();
  for (const auto& [number, stored] : views) {
    const SE3& world_from_camera = *pose++;
    const std::optional<UnpackedView> view = unpack_view(*stored);
    if (!view || !is_of(map.camera, *view)) continue;
    rebuilt.integrate({stored->timestamp_ns, world_from_camera, disparity_of(*view), {}});
    ++num_views;
  }
  if (num_views == 0) return 0;
  now.replace_by(rebuilt.snapshot());
  const MapSnapshot snapshot = now.snapshot();
  map.revision = snapshot.revision;
  map.tiles.clear();
  for (const auto& [index, tile] : snapshot.tiles) map.tiles.push_back({index, tile->revision, tile});
  return num_views;
}

StoredMap load_settled_map(const std::filesystem::path& file) {
  StoredMap map = load_map(file);
  FlogOptions flog;
  flog.grid = map.info.grid;
  if (map.behind) let_tiles_follow_path(map, flog, file);
  return map;
}

std::optional<StoredMap> take_up(MapStore& store, const FlogOptions& flog) {
  std::optional<StoredMap> stored = store.load();
  if (!stored) return std::nullopt;
  check_same_grid(store.path(), stored->info.grid, flog.grid);
  const bool other_rules = follow_options(stored->info, flog);
  const bool changes = other_rules || stored->behind || !store.ended_cleanly();
  if (stored->behind) let_tiles_follow_path(*stored, flog, store.path());
  if (!changes) return stored;
  outrank_what_viewers_know(*stored);
  store_now(store, *stored);
  return stored;
}

}  // namespace flogmap
