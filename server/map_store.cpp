#include "server/map_store.hpp"

#include <stdexcept>
#include <utility>

#include "server/store/file_lock.hpp"
#include "server/store/map_meta.hpp"
#include "server/store/map_reader.hpp"
#include "server/store/map_schema.hpp"
#include "server/store/map_tables.hpp"
#include "server/store/sqlite.hpp"

namespace flogmap {
namespace {

SqliteDatabase open_for_writing(const std::filesystem::path& path) {
  SqliteDatabase database(path, SqliteDatabase::Mode::write);
  if (is_blank(database)) create_map_schema(database);
  check_map_schema(database);
  // WAL: readers and the writer do not wait for one another. FULL: a commit outlives a power cut; one sync
  // a second is cheap. The limit gives the space of a burst back.
  database.execute(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA journal_size_limit = 16777216");
  return database;
}

}  // namespace

struct MapStore::State {
  explicit State(std::filesystem::path file)
      : path(std::move(file)), lock(path), database(open_for_writing(path)) {
    if (!has_header(database)) return;
    const StoredMap header = read_header(database);
    epoch = header.epoch;
    grid = header.info.grid;
    committed = read_seal(database);
    ended_cleanly = committed.clean;
    tables.resume(committed, grid.num_layers());
    if (!ended_cleanly) return;  // it says so already; after a kill there may be no room to say it again
    tables.set_clean(false);
    commit();
  }

  void ensure_transaction() {
    if (!database.in_transaction()) database.execute("BEGIN IMMEDIATE");
  }

  MapTables& writable() {
    if (epoch.empty()) throw std::logic_error(path.string() + ": begin() a map before adding to it");
    ensure_transaction();
    return tables;
  }

  void commit() {
    if (epoch.empty()) return;
    ensure_transaction();
    tables.write_seal();
    database.execute("COMMIT");
    committed = tables.seal();
    committed_epoch = epoch;
    committed_grid = grid;
  }

  void rollback() {
    if (database.in_transaction()) database.execute("ROLLBACK");
    epoch = committed_epoch;
    grid = committed_grid;
    if (!epoch.empty()) tables.resume(committed, grid.num_layers());
  }

  /// One plain file again, marked as closed by its owner. If that fails nothing is lost but the mark.
  void close() {
    try {
      rollback();
      if (epoch.empty()) return;
      tables.set_clean(true);
      commit();
      database.execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
    } catch (const SqliteError&) {
      return;
    }
  }

  std::filesystem::path path;
  FileLock lock;  // taken before the database is opened, given back after it is closed
  SqliteDatabase database;
  MapTables tables{database};
  std::string epoch, committed_epoch;  // empty: no map was begun
  GridSpec grid, committed_grid;
  MapSeal committed;
  bool ended_cleanly = true;
};

MapStore::MapStore(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;
MapStore::~MapStore() {
  if (state_) state_->close();
}

std::optional<StoredMap> MapStore::load() const {
  if (!has_header(state_->database)) return std::nullopt;
  return read_map(state_->database);
}

bool MapStore::ended_cleanly() const { return state_->ended_cleanly; }

void MapStore::begin(const StoredMap& map) {
  check_header(map);
  if (map.epoch == state_->epoch) check_same_grid(state_->path, state_->grid, map.info.grid);
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

void MapStore::put_view(const StoredView& view) { state_->writable().put_view(view); }

std::optional<StoredView> MapStore::view(std::int64_t number) const {
  return read_view(state_->database, number);
}

std::vector<std::int64_t> MapStore::view_numbers() const { return read_view_numbers(state_->database); }

void MapStore::commit() { state_->commit(); }
void MapStore::rollback() { state_->rollback(); }
std::uint64_t MapStore::revision() const {
  return state_->epoch.empty() ? 0 : state_->tables.seal().revision;
}
const std::filesystem::path& MapStore::path() const { return state_->path; }

}  // namespace flogmap
