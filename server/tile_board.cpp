#include "server/tile_board.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace flogmap {

TileBoard::TileBoard(MapInfo info, Operators operators) : info_(std::move(info)), operators_(operators) {}

std::vector<Slot> TileBoard::update(const std::vector<TileUpdate>& updates) {
  std::vector<Slot> changed;
  std::map<TileKey, std::uint64_t>
      parents;  // of the level that was just done, and the revision of their change
  for (const TileUpdate& update : updates) {
    if (!take(update)) continue;
    const TileKey key{0, update.index.x, update.index.y};
    changed.push_back(slots_.at(key));
    std::uint64_t& revision = parents[parent_of(key)];
    revision = std::max(revision, update.revision);
  }
  for (int level = 1; level < kOverviewLevels; ++level) {
    std::map<TileKey, std::uint64_t> next;
    for (const auto& [key, revision] : parents) {
      if (!refresh_overview(key, revision)) continue;
      changed.push_back(slots_.at(key));
      std::uint64_t& above = next[parent_of(key)];
      above = std::max(above, revision);
    }
    parents = std::move(next);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

bool TileBoard::take(const TileUpdate& update) {
  const TileKey key{0, update.index.x, update.index.y};
  const auto known = find(key);
  if (known ? entries_[*known].revision >= update.revision : !update.tile) return false;
  Entry& entry = entries_[slot_of(key)];
  entry.revision = update.revision;
  entry.exists = update.tile != nullptr;
  entry.tile = update.tile;
  entry.layer_messages.clear();
  if (update.tile) {
    tiles_[update.index] = update.tile;
  } else {
    tiles_.erase(update.index);
  }
  return true;
}

bool TileBoard::refresh_overview(TileKey key, std::uint64_t revision) {
  bool any = false;
  for (int child = 0; child < 4; ++child) {
    const auto slot = find(child_of(key, child));
    any = any || (slot && entries_[*slot].exists);
  }
  if (!any && !find(key)) return false;
  Entry& entry = entries_[slot_of(key)];
  entry.revision = std::max(entry.revision, revision);
  entry.exists = any;
  entry.tile.reset();
  entry.values.clear();
  entry.layer_messages.clear();
  return true;
}

std::optional<Slot> TileBoard::find(TileKey key) const {
  const auto found = slots_.find(key);
  return found == slots_.end() ? std::nullopt : std::optional(found->second);
}

Slot TileBoard::slot_of(TileKey key) {
  const auto [found, fresh] = slots_.try_emplace(key, num_slots());
  if (fresh) entries_.emplace_back().key = key;
  return found->second;
}

const std::shared_ptr<const Tile>& TileBoard::tile(Slot slot) {
  if (!entries_[slot].tile) make_overview(slot);
  return entries_[slot].tile;
}

void TileBoard::make_overview(Slot slot) {
  const TileKey key = entries_[slot].key;
  std::array<std::optional<Slot>, 4> slots;
  ChildTiles children{};
  for (int child = 0; child < 4; ++child) {
    slots[child] = find(child_of(key, child));
    if (slots[child] && exists(*slots[child])) children[child] = tile(*slots[child]).get();
  }
  std::vector<PlaneBytes> values;
  for (int layer = 0; layer < info_.grid.num_layers(); ++layer) {
    std::array<PlaneBytes, 4> planes;
    for (int child = 0; child < 4; ++child) {
      if (children[child]) planes[child] = value(*slots[child], layer);
    }
    values.push_back(overview_value_plane({&planes[0], &planes[1], &planes[2], &planes[3]}));
  }
  auto made = std::make_shared<Tile>(overview_tile(children, info_));
  made->revision = entries_[slot].revision;
  entries_[slot].tile = std::move(made);
  entries_[slot].values = std::move(values);
}

PlaneBytes TileBoard::value(Slot slot, int layer) {
  const std::shared_ptr<const Tile> cells = tile(slot);
  const Entry& entry = entries_[slot];
  if (entry.key.level > 0) return entry.values[layer];
  return value_plane(*cells, layer, info_.full_confidence_rays[layer], operators_);
}

const Bytes& TileBoard::layer_message(Slot slot, int layer, Planes planes) {
  const int num_layers = info_.grid.num_layers();
  std::vector<Bytes>& made = entries_[slot].layer_messages;
  made.resize(2 * static_cast<std::size_t>(num_layers));
  Bytes& message = made[(planes == Planes::value ? 0 : num_layers) + layer];
  if (message) return message;
  std::string encoded;
  if (planes == Planes::value) {
    encoded = encode_layer_planes(layer, planes, deflate_planes(value(slot, layer)), {});
  } else {
    const std::shared_ptr<const Tile> cells = tile(slot);
    encoded = encode_layer_planes(
        layer, planes, deflate_planes(evidence_planes(*cells, layer, info_.full_confidence_rays[layer])),
        deflate_planes(change_plane(*cells, layer)));
  }
  message = to_shared(std::move(encoded));
  return message;
}

std::vector<Bytes> TileBoard::layer_messages(Slot slot, const TileChoice& choice) {
  std::vector<Bytes> layers;
  for (int layer = 0; layer < info_.grid.num_layers(); ++layer) {
    const bool chosen =
        choice.layers.empty() || std::binary_search(choice.layers.begin(), choice.layers.end(), layer);
    if (chosen) layers.push_back(layer_message(slot, layer, choice.planes));
  }
  return layers;
}

Bytes TileBoard::message(Slot slot, const TileChoice& choice) {
  const std::vector<Bytes> layers = layer_messages(slot, choice);
  return to_shared(encode_tile(key(slot), revision(slot), layers));
}

std::size_t TileBoard::message_size(Slot slot, const TileChoice& choice) {
  constexpr std::size_t kHead = 48;  // key, revision and the lengths, at most
  std::size_t size = kHead;
  for (const Bytes& layer : layer_messages(slot, choice)) size += layer->size() + 8;
  return size;
}

std::size_t TileBoard::map_bytes() const {
  return tiles_.size() * sizeof(Cell) * kTileColumns * static_cast<std::size_t>(info_.grid.num_layers());
}

std::optional<Bounds> TileBoard::bounds() const {
  if (tiles_.empty()) return std::nullopt;
  const auto first = tiles_.begin()->first;
  Bounds all = tile_bounds(info_.grid, {0, first.x, first.y});
  for (const auto& [index, tile] : tiles_) {
    const Bounds b = tile_bounds(info_.grid, {0, index.x, index.y});
    all = {std::min(all.x_min, b.x_min), std::min(all.y_min, b.y_min), std::max(all.x_max, b.x_max),
           std::max(all.y_max, b.y_max)};
  }
  return all;
}

std::optional<std::uint64_t> TileBoard::oldest_revision() const {
  std::optional<std::uint64_t> oldest;
  for (const Entry& entry : entries_) {
    if (entry.exists) oldest = std::min(oldest.value_or(entry.revision), entry.revision);
  }
  return oldest;
}

}  // namespace flogmap
