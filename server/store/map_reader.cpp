#include "server/store/map_reader.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/store/map_meta.hpp"
#include "server/store/map_rows.hpp"
#include "server/store/map_schema.hpp"
#include "server/store/tile_blob.hpp"

namespace flogmap {
namespace {

constexpr std::uint64_t kMaxMapBytes = std::uint64_t{16} << 30;

/// One consistent view of the file while another program writes to it; nothing if one is open already.
class ReadTransaction {
 public:
  explicit ReadTransaction(SqliteDatabase& database)
      : database_(database), mine_(!database.in_transaction()) {
    if (mine_) database_.execute("BEGIN");
  }
  ReadTransaction(const ReadTransaction&) = delete;
  ReadTransaction& operator=(const ReadTransaction&) = delete;
  ~ReadTransaction() {
    try {
      if (mine_ && database_.in_transaction()) database_.execute("ROLLBACK");
    } catch (const SqliteError&) {
      return;  // nothing was written, so nothing is lost
    }
  }

 private:
  SqliteDatabase& database_;
  bool mine_;
};

std::string name_of(TileIndex index) {
  return "tile " + std::to_string(index.x) + "," + std::to_string(index.y);
}

/// Columns of the tile must fit the cell index.
TileIndex checked_index(const std::string& file, std::int64_t x, std::int64_t y) {
  constexpr std::int64_t kLimit = (std::int64_t{1} << 31) >> kTileShift;
  if (x < -kLimit || x >= kLimit || y < -kLimit || y >= kLimit) {
    throw damaged(file, "tile " + std::to_string(x) + "," + std::to_string(y) + " is out of range");
  }
  return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

TileUpdate read_tile(const SqliteStatement& row, const std::string& file, TileCodec& codec) {
  const TileIndex index = checked_index(file, row.integer(0), row.integer(1));
  const auto revision = static_cast<std::uint64_t>(row.integer(2));
  const auto bytes = row.blob(3);
  if (tile_checksum(index, revision, bytes) != static_cast<std::uint64_t>(row.integer(4))) {
    throw damaged(file, name_of(index) + " fails its checksum");
  }
  auto cells = codec.decode(bytes);
  if (!cells) throw damaged(file, name_of(index) + " does not unpack to its layers");
  auto tile = std::make_shared<Tile>();
  tile->cells = std::move(*cells);
  tile->revision = revision;
  return {index, revision, std::move(tile)};
}

/// Compressed, a small file may claim any number of tiles; memory is not given to claims.
void check_memory(const SqliteDatabase& database, const MapSeal& seal, const GridSpec& grid) {
  const std::uint64_t tile_bytes =
      sizeof(Cell) * kTileColumns * static_cast<std::uint64_t>(grid.num_layers());
  if (seal.num_tiles <= kMaxMapBytes / tile_bytes) return;
  throw std::runtime_error(database.file() + ": holds " + std::to_string(seal.num_tiles) +
                           " tiles, more than the " + std::to_string(kMaxMapBytes >> 30) +
                           " GiB of cells that are loaded at once; use smaller maps");
}

void read_tiles(const SqliteDatabase& database, const MapSeal& seal, StoredMap& map) {
  check_memory(database, seal, map.info.grid);
  TileCodec codec(map.info.grid.num_layers());
  SqliteStatement row = database.prepare("SELECT x, y, revision, cells, checksum FROM tiles ORDER BY x, y");
  std::uint64_t sum = 0;
  while (map.tiles.size() <= seal.num_tiles && row.step()) {
    map.tiles.push_back(read_tile(row, database.file(), codec));
    const TileUpdate& tile = map.tiles.back();
    if (tile.revision > seal.revision)
      throw damaged(database.file(), name_of(tile.index) + " is from the future");
    sum += static_cast<std::uint64_t>(row.integer(4));
  }
  const auto same_index = [](const TileUpdate& a, const TileUpdate& b) { return a.index >= b.index; };
  const bool ordered = std::ranges::adjacent_find(map.tiles, same_index) == map.tiles.end();
  if (!ordered || map.tiles.size() != seal.num_tiles || sum != seal.tiles_sum) {
    throw damaged(database.file(), "tiles are missing or doubled");
  }
}

TrajectoryEntry read_pose(const SqliteStatement& row, const std::string& file, std::size_t number) {
  const auto pose = pose_of(row.blob(2));
  const std::int64_t state = row.integer(3);
  const std::int64_t mapped = row.integer(4);
  const bool possible = pose && state >= 0 && state <= static_cast<std::int64_t>(TrackingState::lost) &&
                        (mapped == 0 || mapped == 1) && row.integer(0) == static_cast<std::int64_t>(number);
  if (!possible) throw damaged(file, "pose " + std::to_string(number) + " is impossible");
  TrajectoryEntry entry{row.integer(1), *pose, static_cast<TrackingState>(state), mapped == 1};
  if (pose_checksum(number, entry) != static_cast<std::uint64_t>(row.integer(5))) {
    throw damaged(file, "pose " + std::to_string(number) + " fails its checksum");
  }
  return entry;
}

void read_trajectory(const SqliteDatabase& database, const MapSeal& seal, StoredMap& map) {
  SqliteStatement row = database.prepare(
      "SELECT number, timestamp_ns, pose, state, mapped, checksum FROM trajectory ORDER BY number");
  std::uint64_t sum = 0;
  while (row.step()) {
    map.trajectory.push_back(read_pose(row, database.file(), map.trajectory.size()));
    sum += static_cast<std::uint64_t>(row.integer(5));
  }
  if (map.trajectory.size() != seal.num_poses || sum != seal.poses_sum) {
    throw damaged(database.file(), "poses are missing");
  }
}

StoredView view_of(const SqliteStatement& row, const std::string& file) {
  const auto pose = pose_of(row.blob(2));
  const std::string name = "view " + std::to_string(row.integer(0));
  if (!pose) throw damaged(file, name + " has an impossible pose");
  const auto bytes = row.blob(4);
  StoredView view{
      row.integer(0), row.integer(1), *pose, static_cast<int>(row.integer(3)), {bytes.begin(), bytes.end()}};
  if (view_checksum(view) != static_cast<std::uint64_t>(row.integer(5))) {
    throw damaged(file, name + " fails its checksum");
  }
  return view;
}

void read_views(const SqliteDatabase& database, const MapSeal& seal, StoredMap& map) {
  SqliteStatement row =
      database.prepare("SELECT number, timestamp_ns, pose, codec, data, checksum FROM views ORDER BY number");
  std::uint64_t sum = 0;
  while (row.step()) {
    map.views.push_back(std::make_shared<const StoredView>(view_of(row, database.file())));
    sum += static_cast<std::uint64_t>(row.integer(5));
  }
  if (map.views.size() != seal.num_views || sum != seal.views_sum) {
    throw damaged(database.file(), "views are missing");
  }
}

}  // namespace

StoredMap read_map(SqliteDatabase& database) {
  const ReadTransaction one_moment(database);
  const MapSeal seal = read_seal(database);
  StoredMap map = read_header(database);
  map.revision = seal.revision;
  map.behind = seal.behind;
  read_tiles(database, seal, map);
  read_trajectory(database, seal, map);
  read_views(database, seal, map);
  return map;
}

std::optional<StoredView> read_view(const SqliteDatabase& database, std::int64_t number) {
  SqliteStatement row = database.prepare(
      "SELECT number, timestamp_ns, pose, codec, data, checksum FROM views WHERE number = ?");
  row.bind(1, number);
  if (!row.step()) return std::nullopt;
  return view_of(row, database.file());
}

std::vector<std::int64_t> read_view_numbers(const SqliteDatabase& database) {
  std::vector<std::int64_t> numbers;
  SqliteStatement row = database.prepare("SELECT number FROM views ORDER BY number");
  while (row.step()) numbers.push_back(row.integer(0));
  return numbers;
}

}  // namespace flogmap
