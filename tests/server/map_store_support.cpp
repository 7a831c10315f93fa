#include "tests/server/map_store_support.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

namespace flogmap::testing {
namespace {

namespace fs = std::filesystem;

std::uint16_t up_to(std::mt19937& random, int limit) {
  return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(0, limit)(random));
}

Cell random_cell(std::mt19937& random) {
  const std::uint16_t empty = up_to(random, 65535);
  return {empty, up_to(random, 65535 - empty), static_cast<std::uint16_t>(1 + up_to(random, 3000)),
          up_to(random, 65535)};
}

std::string name_of(TileIndex index) { return std::to_string(index.x) + "," + std::to_string(index.y); }

std::string tile_difference(const TileUpdate& a, const TileUpdate& b) {
  if (a.index != b.index) return "tile index " + name_of(a.index) + " and " + name_of(b.index);
  if (a.revision != b.revision || a.tile->revision != b.tile->revision)
    return "revision of " + name_of(a.index);
  return a.tile->cells == b.tile->cells ? "" : "cells of " + name_of(a.index);
}

bool same(const TrajectoryEntry& a, const TrajectoryEntry& b) {
  return a.timestamp_ns == b.timestamp_ns && a.state == b.state && a.mapped == b.mapped &&
         a.world_from_camera.matrix() == b.world_from_camera.matrix();
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(fs::temp_directory_path()) {}

TemporaryFolder TemporaryFolder::in_memory() {
  const bool there = ::access("/dev/shm", W_OK) == 0;
  return TemporaryFolder(there ? fs::path("/dev/shm") : fs::temp_directory_path());
}

TemporaryFolder::TemporaryFolder(const fs::path& where) {
  static std::atomic<int> number = 0;
  path_ = where / ("flogmap-test-" + std::to_string(::getpid()) + "-" + std::to_string(number++));
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

TileUpdate random_tile(TileIndex index, std::uint64_t revision, int num_layers, std::uint32_t seed) {
  std::mt19937 random(seed);
  auto tile = std::make_shared<Tile>();
  tile->revision = revision;
  tile->cells.resize(static_cast<std::size_t>(num_layers) * kTileColumns);
  for (int i = 0; i < 300; ++i) {
    tile->cells[random() % tile->cells.size()] = random_cell(random);
  }
  return {index, revision, std::move(tile)};
}

TrajectoryEntry random_pose(std::int64_t timestamp_ns, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-3, 3);
  TrajectoryEntry entry;
  entry.timestamp_ns = timestamp_ns;
  const Eigen::Quaterniond q(number(random), number(random), number(random), number(random));
  entry.world_from_camera = Eigen::Translation3d(number(random), number(random), -0.0) * q.normalized();
  entry.state = static_cast<TrackingState>(seed % 4);
  entry.mapped = seed % 3 == 0;
  return entry;
}

StoredMap empty_map(std::uint32_t seed, int num_layers) {
  StoredMap map;
  map.epoch = "00000000" + std::to_string(10'000'000 + seed % 10'000'000);
  map.info.grid = {0.02, {}};
  for (int k = 0; k <= num_layers; ++k) map.info.grid.layer_bounds_m.push_back(0.05 + 0.7 * k);
  map.info.full_confidence_rays.assign(static_cast<std::size_t>(num_layers), 823.5F);
  map.info.min_rays = 9;
  map.camera = {416.8, 160.25, 120.5, 0.07, 320, 240};
  map.options_json = R"({"cell_size":0.02,"seed":)" + std::to_string(seed) + "}";
  map.calibration_json = R"({"dialect":"simulated"})";
  return map;
}

StoredMap random_map(std::uint32_t seed, const MapSize& size) {
  StoredMap map = empty_map(seed, size.num_layers);
  const int low = -size.tiles_per_side / 2;
  for (int x = low; x < low + size.tiles_per_side; ++x) {
    for (int y = low; y < low + size.tiles_per_side; ++y) {
      ++map.revision;
      map.tiles.push_back(random_tile({x, y}, map.revision, size.num_layers,
                                      seed * 1000 + static_cast<std::uint32_t>(map.revision)));
    }
  }
  for (int i = 0; i < size.num_poses; ++i) {
    map.trajectory.push_back(random_pose(50'000'000LL * i, seed + static_cast<std::uint32_t>(i)));
  }
  return map;
}

std::string difference(const StoredMap& a, const StoredMap& b) {
  if (a.epoch != b.epoch) return "epoch";
  if (a.info != b.info) return "info";
  if (a.camera != b.camera) return "camera";
  if (a.revision != b.revision) return "revision";
  if (a.level != b.level) return "level";
  if (a.behind != b.behind) return "behind";
  if (a.options_json != b.options_json || a.calibration_json != b.calibration_json) return "options";
  if (a.tiles.size() != b.tiles.size()) return "number of tiles";
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    if (auto found = tile_difference(a.tiles[i], b.tiles[i]); !found.empty()) return found;
  }
  if (a.trajectory.size() != b.trajectory.size()) return "number of poses";
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    if (!same(a.trajectory[i], b.trajectory[i])) return "pose " + std::to_string(i);
  }
  return "";
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::vector<std::uint8_t> read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const fs::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace flogmap::testing
