// GET /maps/{id}/changes?since=REV&epoch=E&bbox=&limit=: a polling client's whole protocol.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kUsualLimit = 1000;
constexpr std::int64_t kMaxLimit = 10000;

/// Slots that changed after `since`, oldest first.
std::vector<Slot> changed_slots(const TileBoard& board, std::uint64_t since,
                                const std::optional<Bounds>& bbox) {
  std::vector<Slot> slots;
  for (Slot slot = 0; slot < board.num_slots(); ++slot) {
    if (board.revision(slot) <= since) continue;
    if (!board.exists(slot) && since == 0) continue;
    if (bbox && !intersect(*bbox, tile_bounds(board.info().grid, board.key(slot)))) continue;
    slots.push_back(slot);
  }
  std::sort(slots.begin(), slots.end(), [&](Slot a, Slot b) {
    return std::pair(board.revision(a), board.key(a)) < std::pair(board.revision(b), board.key(b));
  });
  return slots;
}

/// At most `limit`, but always whole revisions, and at least one: so that `rev` says truly how far the client
/// is.
void cut(std::vector<Slot>& slots, const TileBoard& board, std::size_t limit) {
  if (slots.size() <= limit) return;
  auto end = slots.begin() + static_cast<std::ptrdiff_t>(limit);
  const std::uint64_t broken = board.revision(*end);
  while (end != slots.begin() && board.revision(*(end - 1)) == broken) --end;
  if (end == slots.begin()) {
    end = std::find_if(slots.begin(), slots.end(), [&](Slot slot) { return board.revision(slot) != broken; });
  }
  slots.erase(end, slots.end());
}

/// A revision that never was is one of a killed program, which could not store it.
void require_known(const ApiRequest& request, std::uint64_t since, const ServedMap& map) {
  const auto epoch = request.parameter("epoch");
  if (epoch && *epoch != map.epoch()) {
    throw RefusedRequest(409, "epoch-changed",
                         "another map began; its epoch is " + map.epoch() + ", start from since=0", "epoch");
  }
  if (since > map.revision()) {
    throw RefusedRequest(409, "epoch-changed", "this map never had that revision; start from since=0",
                         "since");
  }
}

ApiAnswer get_changes(const ApiRequest& request, ServerState& state) {
  const ServedMap& map = requested_map(request, state);
  const TileBoard& board = map.board();
  const auto since = static_cast<std::uint64_t>(integer_parameter(request, "since", 0, 0, INT64_MAX));
  require_known(request, since, map);
  const auto limit = static_cast<std::size_t>(integer_parameter(request, "limit", kUsualLimit, 1, kMaxLimit));
  std::vector<Slot> slots = changed_slots(board, since, bbox_parameter(request));
  const std::size_t num_changed = slots.size();
  cut(slots, board, limit);
  const bool more = slots.size() < num_changed;
  Json tiles = Json::array(), removed = Json::array();
  for (const Slot slot : slots) {
    const TileKey key = board.key(slot);
    (board.exists(slot) ? tiles : removed)
        .push_back({{"level", key.level}, {"x", key.x}, {"y", key.y}, {"rev", board.revision(slot)}});
  }
  const Json json = {{"epoch", map.epoch()},
                     {"rev", more ? board.revision(slots.back()) : map.revision()},
                     {"more", more},
                     {"tiles", tiles},
                     {"removed", removed}};
  return tagged_json(json.dump(), etag_of(map, request, state.options));
}

}  // namespace

std::vector<Route> change_routes() {
  return {{Method::get, "/api/v1/maps/{}/changes", Role::view, get_changes}};
}

}  // namespace flogmap
