#include "server/map_store.hpp"

#include <stdexcept>
#include <utility>

#include "server/store/map_meta.hpp"
#include "server/store/map_reader.hpp"
#include "server/store/map_tables.hpp"
#include "server/store/sqlite.hpp"
#include "server/store/store_file.hpp"

namespace flogmap {

struct MapStore::State {
  explicit State(std::filesystem::path path) : file(std::move(path)) {
    if (!has_header(file.database())) return;
    const StoredMap header = read_header(file.database());
    epoch = committed_epoch = header.epoch;
    grid = committed_grid = header.info.grid;
    committed = read_seal(file.database());
    mark_as_written();
  }

  /// So that the next start can tell, should this one be killed. After a kill it stands there already; where
  /// there is no room for it, this start is to be taken for one after a kill.
  void mark_as_written() {
    ended_cleanly = std::exchange(committed.clean, false);
    tables.resume(committed, grid.num_layers());
    if (!ended_cleanly) return;
    try {
      commit();
    } catch (const SqliteError&) {
      rollback();
      ended_cleanly = false;
    }
  }

  /// Of a disk that refused before, what is there may have been changed by somebody else meanwhile.
  void make_writable() {
    if (!file.writable()) {
      file.make_writable();
      unchecked = !epoch.empty();
    }
    if (!unchecked) return;
    MapSeal found = read_seal(file.database());
    found.clean = committed.clean;
    unchecked = read_header(file.database()).epoch != committed_epoch || found != committed;
    if (!unchecked) return;
    throw std::runtime_error(file.path().string() +
                             ": was written by another program meanwhile; start again, or name another file");
  }

  void ensure_transaction() {
    make_writable();
    if (!file.database().in_transaction()) file.database().execute("BEGIN IMMEDIATE");
  }

  MapTables& writable() {
    if (epoch.empty()) throw std::logic_error(file.path().string() + ": begin() a map before adding to it");
    ensure_transaction();
    return tables;
  }

  void commit() {
    if (epoch.empty()) return;
    ensure_transaction();
    tables.write_seal();
    file.database().execute("COMMIT");
    committed = tables.seal();
    committed_epoch = epoch;
    committed_grid = grid;
  }

  void rollback() {
    if (file.database().in_transaction()) file.database().execute("ROLLBACK");
    epoch = committed_epoch;
    grid = committed_grid;
    if (!epoch.empty()) tables.resume(committed, grid.num_layers());
  }

  /// One plain file again, marked as closed by its owner. If that fails nothing is lost but the mark.
  void close() {
    try {
      rollback();
      if (epoch.empty() || !file.writable()) return;
      tables.set_clean(true);
      commit();
      file.database().execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
    } catch (const std::runtime_error&) {
      return;
    }
  }

  StoreFile file;
  MapTables tables{file.database()};
  std::string epoch, committed_epoch;  // empty: no map was begun
  GridSpec grid, committed_grid;
  MapSeal committed;
  bool ended_cleanly = true;
  bool unchecked = false;  // could only be read at first: may be another's by now
};

MapStore::MapStore(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;
MapStore::~MapStore() {
  if (state_) state_->close();
}

std::optional<StoredMap> MapStore::load() const {
  if (!has_header(state_->file.database())) return std::nullopt;
  return read_map(state_->file.database());
}

bool MapStore::ended_cleanly() const { return state_->ended_cleanly; }

void MapStore::begin(const StoredMap& map) {
  check_header(map);
  if (map.epoch == state_->epoch) check_same_grid(state_->file.path(), state_->grid, map.info.grid);
  state_->ensure_transaction();
  if (map.epoch == state_->epoch) {
    state_->tables.carry_on(map);
    return;
  }
  state_->tables.set_clean(false);
  state_->tables.replace_all(map);
  state_->epoch = map.epoch;
  state_->grid = map.info.grid;
}

void MapStore::put_tiles(std::span<const TileUpdate> updates) { state_->writable().put_tiles(updates); }

void MapStore::append_trajectory(std::span<const TrajectoryEntry> entries) {
  state_->writable().append_trajectory(entries);
}

void MapStore::rewrite_trajectory(std::span<const TrajectoryEntry> entries) {
  state_->writable().rewrite_trajectory(entries);
}

void MapStore::put_level(const HandLevel& level) { state_->writable().put_level(level); }

void MapStore::set_behind(bool behind) { state_->writable().set_behind(behind); }

void MapStore::put_view(const StoredView& view) { state_->writable().put_view(view); }

std::optional<StoredView> MapStore::view(std::int64_t number) const {
  return read_view(state_->file.database(), number);
}

std::vector<std::int64_t> MapStore::view_numbers() const {
  return read_view_numbers(state_->file.database());
}

void MapStore::commit() { state_->commit(); }
void MapStore::rollback() { state_->rollback(); }
std::uint64_t MapStore::revision() const {
  return state_->epoch.empty() ? 0 : state_->tables.seal().revision;
}
const std::filesystem::path& MapStore::path() const { return state_->file.path(); }

}  // namespace flogmap
