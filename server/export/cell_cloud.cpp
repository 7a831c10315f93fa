#include "server/export/cell_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace flogmap {
namespace {

std::uint8_t shade(float membership, float mu_K) {
  const float faded = 0.5F + (std::clamp(membership, 0.0F, 1.0F) - 0.5F) * mu_K;
  return static_cast<std::uint8_t>(std::lround(255 * faded));
}

CellPoint point_of(const StoredMap& map, CellIndex index, std::size_t layer, const Cell& cell) {
  const auto& z_m = map.info.grid.layer_bounds_m;
  CellPoint point;
  point.x_m = static_cast<float>(cell_middle_m(map.info.grid, index.x));
  point.y_m = static_cast<float>(cell_middle_m(map.info.grid, index.y));
  point.z_m = static_cast<float>((z_m[layer] + z_m[layer + 1]) / 2);
  point.empty = mu_E(cell);
  point.occupied = mu_O(cell);
  point.confidence = confidence(cell, map.info.full_confidence_rays[layer]);
  point.colour = {shade(point.occupied, point.confidence), shade(point.empty, point.confidence),
                  shade(0, point.confidence)};
  point.rays = cell.rays;
  point.layer = static_cast<std::uint8_t>(layer);
  return point;
}

void put(std::string& bytes, std::uint32_t value, int num_bytes) {
  for (int i = 0; i < num_bytes; ++i) bytes += static_cast<char>(value >> (8 * i));
}

void put(std::string& bytes, float value) { put(bytes, std::bit_cast<std::uint32_t>(value), 4); }

}  // namespace

std::vector<CellPoint> cell_cloud(const StoredMap& map) {
  std::vector<CellPoint> points;
  for (const TileUpdate& update : map.tiles) {
    const CellIndex corner = first_cell(update.index);
    const auto& cells = update.tile->cells;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].rays == 0) continue;
      const int column = static_cast<int>(i % kTileColumns);
      const CellIndex index{corner.x + (column & kTileMask), corner.y + (column >> kTileShift)};
      points.push_back(point_of(map, index, i / kTileColumns, cells[i]));
    }
  }
  return points;
}

std::string ply_of(const std::vector<CellPoint>& points) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment flogmap: seen cells, metres\nelement vertex " +
      std::to_string(points.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) bytes += std::string("property float ") + name + "\n";
  for (const char* name : {"red", "green", "blue"}) bytes += std::string("property uchar ") + name + "\n";
  for (const char* name : {"empty", "occupied", "confidence"})
    bytes += std::string("property float ") + name + "\n";
  bytes += "property ushort rays\nproperty uchar layer\nend_header\n";
  for (const CellPoint& point : points) {
    for (const float value : {point.x_m, point.y_m, point.z_m}) put(bytes, value);
    for (const std::uint8_t value : point.colour) put(bytes, value, 1);
    for (const float value : {point.empty, point.occupied, point.confidence}) put(bytes, value);
    put(bytes, point.rays, 2);
    put(bytes, point.layer, 1);
  }
  return bytes;
}

std::string pcd_of(const std::vector<CellPoint>& points) {
  const std::string number = std::to_string(points.size());
  std::string bytes =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb empty occupied confidence\n"
      "SIZE 4 4 4 4 4 4 4\nTYPE F F F U F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH " +
      number + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number + "\nDATA binary\n";
  for (const CellPoint& point : points) {
    for (const float value : {point.x_m, point.y_m, point.z_m}) put(bytes, value);
    const auto [r, g, b] = point.colour;
    put(bytes, static_cast<std::uint32_t>((r << 16) | (g << 8) | b), 4);
    for (const float value : {point.empty, point.occupied, point.confidence}) put(bytes, value);
  }
  return bytes;
}

}  // namespace flogmap
