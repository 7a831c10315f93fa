// The latest bytes of every tile, at every overview level, made once and shared by all clients.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "mapping/tile_update.hpp"
#include "server/client_message.hpp"
#include "server/overview.hpp"
#include "server/tile_key.hpp"
#include "server/tile_planes.hpp"
#include "server/wire.hpp"

namespace flogmap {

/// A tile's place on the board: dense from 0, never given to another tile while the board lives.
using Slot = std::uint32_t;

/// All tiles of one epoch. Level 0 comes from the mapping; overviews and bytes are made when first asked for.
/// Not thread-safe: the network thread owns it.
class TileBoard {
 public:
  TileBoard(MapInfo info, Operators operators);

  /// Takes in changed tiles and returns every slot that changed by it, overviews included, each once.
  /// An update that is older than what the board has is ignored. Without a tile it removes one.
  std::vector<Slot> update(const std::vector<TileUpdate>& updates);

  [[nodiscard]] Slot num_slots() const { return static_cast<Slot>(entries_.size()); }
  [[nodiscard]] std::optional<Slot> find(TileKey key) const;
  [[nodiscard]] TileKey key(Slot slot) const { return entries_[slot].key; }
  [[nodiscard]] std::uint64_t revision(Slot slot) const { return entries_[slot].revision; }
  [[nodiscard]] bool exists(Slot slot) const { return entries_[slot].exists; }

  /// Cells of an existing tile; those of an overview are made now if need be.
  const std::shared_ptr<const Tile>& tile(Slot slot);

  /// The plane M of one layer of an existing tile.
  PlaneBytes value(Slot slot, int layer);

  /// The message Tile with the chosen layers of an existing tile, and how long it is, about.
  Bytes message(Slot slot, const TileChoice& choice);
  std::size_t message_size(Slot slot, const TileChoice& choice);

  [[nodiscard]] const MapInfo& info() const { return info_; }
  [[nodiscard]] Operators operators() const { return operators_; }
  [[nodiscard]] std::size_t map_bytes() const;  // of level 0's cells
  [[nodiscard]] std::optional<Bounds> bounds() const;
  /// The least revision of an existing tile; nothing: there is none.
  [[nodiscard]] std::optional<std::uint64_t> oldest_revision() const;

  /// The tiles of level 0.
  [[nodiscard]] const std::map<TileIndex, std::shared_ptr<const Tile>>& tiles() const { return tiles_; }

 private:
  struct Entry {
    TileKey key;
    std::uint64_t revision = 0;
    bool exists = false;
    std::shared_ptr<const Tile> tile;   // null: removed, or an overview that is out of date
    std::vector<PlaneBytes> values;     // of an overview, per layer; made together with `tile`
    std::vector<Bytes> layer_messages;  // [planes * num_layers + layer]; null: not made since the change
  };

  Slot slot_of(TileKey key);
  bool take(const TileUpdate& update);
  bool refresh_overview(TileKey key, std::uint64_t revision);
  void make_overview(Slot slot);
  std::vector<Bytes> layer_messages(Slot slot, const TileChoice& choice);
  const Bytes& layer_message(Slot slot, int layer, Planes planes);

  MapInfo info_;
  Operators operators_;
  std::vector<Entry> entries_;
  std::unordered_map<TileKey, Slot, TileKeyHash> slots_;
  std::map<TileIndex, std::shared_ptr<const Tile>> tiles_;
};

}  // namespace flogmap
