#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/served_map.hpp"
#include "server/tile_key.hpp"

namespace flogmap {

/// What a page has, kept by the rules of stream.proto: the newest revision of each tile wins.
class TileMirror {
 public:
  /// What one server message did to the mirror.
  enum class Effect { other, welcome, tiles, reset, snapshot_begin, snapshot_end, goodbye };

  /// Takes in any ServerMessage; throws std::runtime_error if it is none or breaks a rule of the format.
  Effect take(std::string_view message);

  void forget(const std::vector<TileKey>& keys);

  struct Tile {
    std::uint64_t revision = 0;
    std::string bytes;  // the message Tile
  };
  [[nodiscard]] const std::map<TileKey, Tile>& tiles() const { return tiles_; }
  [[nodiscard]] const std::set<TileKey>& forgotten() const { return forgotten_; }
  [[nodiscard]] const std::string& epoch() const { return epoch_; }
  /// Highest revision of which it knows that it has every tile.
  [[nodiscard]] std::uint64_t complete_revision() const { return complete_revision_; }
  /// Bytes of all TileBatch and ImageFrame messages: what an Ack must say.
  [[nodiscard]] std::uint64_t batch_bytes() const { return batch_bytes_; }
  [[nodiscard]] const std::vector<std::int64_t>& path_ns() const { return path_ns_; }
  /// A new connection counts from 0.
  void reconnect() { batch_bytes_ = 0; }

 private:
  std::map<TileKey, Tile> tiles_;
  std::set<TileKey> forgotten_;
  std::vector<std::int64_t> path_ns_;
  std::string epoch_;
  std::uint64_t complete_revision_ = 0;
  std::uint64_t batch_bytes_ = 0;
};

/// How the mirror differs from the map in words; empty if it holds the same bytes, but for what it forgot.
std::string difference(const TileMirror& mirror, ServedMap& map, const TileChoice& choice);

}  // namespace flogmap
