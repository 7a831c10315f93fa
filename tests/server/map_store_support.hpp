// Maps to store, and a folder to store them in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "server/map_store.hpp"

namespace flogmap::testing {

/// A fresh folder that is removed with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder();
  /// In memory where the machine has such a place: for tests that write so often that they would wait for a
  /// disk.
  static TemporaryFolder in_memory();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(const std::filesystem::path& where);
  std::filesystem::path path_;
};

/// A tile with some hundred seen cells, different for every seed.
TileUpdate random_tile(TileIndex index, std::uint64_t revision, int num_layers, std::uint32_t seed);
TrajectoryEntry random_pose(std::int64_t timestamp_ns, std::uint32_t seed);

struct MapSize {
  int num_layers = 3;
  int tiles_per_side = 3;  // around the origin, so that indices have both signs
  int num_poses = 20;
};
StoredMap random_map(std::uint32_t seed, const MapSize& size = {});
/// A map without tiles and path.
StoredMap empty_map(std::uint32_t seed, int num_layers);

/// Empty if the maps are equal to the last bit, else the first difference in words.
std::string difference(const StoredMap& a, const StoredMap& b);

/// The message of the std::runtime_error that this throws; empty if it throws none.
std::string error_of(const std::function<void()>& work);

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes);

}  // namespace flogmap::testing
