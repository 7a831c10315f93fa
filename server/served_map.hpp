#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/map_header.hpp"
#include "server/publication.hpp"
#include "server/tile_board.hpp"
#include "server/tile_pictures.hpp"
#include "server/views/view_shelf.hpp"
#include "server/wire.hpp"

namespace flogmap {

/// A map as it is served: live or stored. The network thread owns it.
class ServedMap {
 public:
  ServedMap(std::string id, MapBegin begin, Operators operators);

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] const std::string& epoch() const { return epoch_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const std::vector<TrajectoryEntry>& trajectory() const { return trajectory_; }
  [[nodiscard]] bool trajectory_was_rewritten() const { return rewritten_; }
  /// Counts the changes of trajectory and views, which change no tile and so no revision.
  [[nodiscard]] std::uint64_t path_version() const { return path_version_; }
  [[nodiscard]] const StereoCamera& camera() const { return camera_; }
  [[nodiscard]] Operators operators() const { return board_.operators(); }
  [[nodiscard]] TileBoard& board() { return board_; }
  [[nodiscard]] const TileBoard& board() const { return board_; }
  [[nodiscard]] TilePictures& pictures() { return pictures_; }
  [[nodiscard]] const ViewShelf& views() const { return views_; }
  [[nodiscard]] MapHeader header() const;

  /// Every cell at this revision, for other threads; made once per revision.
  std::shared_ptr<const MapSnapshot> snapshot();

  /// Returns the slots that changed, overviews included.
  std::vector<Slot> update(std::uint64_t revision, const std::vector<TileUpdate>& tiles);
  void append(const TrajectoryEntry& entry);
  void add(const SharedView& view);
  /// Entries later than the last one given stay.
  void rewrite(std::vector<TrajectoryEntry> trajectory);

  /// A TileBatch of these slots, removed tiles included. Clients in step share its bytes.
  Bytes tile_batch(std::uint64_t revision, bool complete, std::span<const Slot> slots,
                   const TileChoice& choice);

  /// TrajectoryAppend, or TrajectoryRewrite if `reason` is not null, of entries [first, first + count).
  Bytes trajectory_message(std::size_t first, std::size_t count, const std::string* rewrite_reason);

 private:
  struct Batch {
    std::uint64_t revision = 0;
    bool complete = false;
    std::vector<Slot> slots;
    std::vector<std::uint64_t> revisions;  // of the slots
    TileChoice choice;
    Bytes bytes;
  };
  struct TrajectoryPart {
    std::size_t first = 0;
    std::size_t count = 0;
    bool rewrite = false;
    Bytes bytes;
  };

  std::string id_;
  std::string epoch_;
  StereoCamera camera_;
  std::uint64_t revision_ = 0;
  TileBoard board_;
  TilePictures pictures_;
  std::vector<TrajectoryEntry> trajectory_;
  ViewShelf views_;
  bool rewritten_ = false;
  std::uint64_t path_version_ = 0;
  std::shared_ptr<const MapSnapshot> snapshot_;  // null: not made since the last change
  std::array<Batch, 4> batches_;                 // the latest, oldest replaced first
  std::size_t oldest_batch_ = 0;
  TrajectoryPart latest_part_;
};

}  // namespace flogmap
