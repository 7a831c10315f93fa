// The seen cells as points, for the point-cloud formats.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/export/picture_file.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// A cell with a ray in it: its middle and its evidence. Colour: red by O, green by E, both faded to grey by
/// missing confidence.
struct CellPoint {
  float x_m = 0, y_m = 0, z_m = 0;
  Rgb colour{};
  float empty = 0, occupied = 0, confidence = 0;  // mu_E, mu_O, mu_K
  std::uint16_t rays = 0;                         // N
  std::uint8_t layer = 0;
};

/// In the order of tiles, layers, rows.
std::vector<CellPoint> cell_cloud(const StoredMap& map);

/// Binary little-endian PLY, one vertex per point: x y z, red green blue, empty occupied confidence, rays,
/// layer.
std::string ply_of(const std::vector<CellPoint>& points);

/// Binary PCD 0.7 (Point Cloud Library): x y z, rgb packed into a number, empty occupied confidence.
std::string pcd_of(const std::vector<CellPoint>& points);

}  // namespace flogmap
