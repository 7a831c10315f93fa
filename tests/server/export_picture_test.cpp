// Pictures of a map, read back as the programs they are for would read them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_value.hpp"
#include "server/export/map_export.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using ::testing::HasSubstr;

constexpr double kSide = 0.02;  // of the cells of random_map()

std::string text_of(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return {bytes.begin(), bytes.end()};
}

/// What map_server publishes: occupancy per cell in [0, 100] or -1, row 0 at the lowest y.
struct OccupancyGrid {
  double resolution = 0, origin_x = 0, origin_y = 0;
  int width = 0, height = 0;
  std::vector<int> cells;

  [[nodiscard]] int at(double x_m, double y_m) const {
    const int column = static_cast<int>(std::floor((x_m - origin_x) / resolution));
    const int row = static_cast<int>(std::floor((y_m - origin_y) / resolution));
    const bool inside = column >= 0 && row >= 0 && column < width && row < height;
    return inside ? cells[static_cast<std::size_t>(row * width + column)] : -1;
  }
};

std::map<std::string, std::string> yaml_of(const std::filesystem::path& path) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text_of(path));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    values[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return values;
}

/// "Value interpretation" of https://wiki.ros.org/map_server.
int interpret(double pixel, double alpha, const std::map<std::string, std::string>& yaml) {
  const double occupied = std::stod(yaml.at("occupied_thresh")), free = std::stod(yaml.at("free_thresh"));
  const double p = yaml.at("negate") == "0" ? (255 - pixel) / 255 : pixel / 255;
  if (yaml.at("mode") == "scale") {
    if (alpha < 255) return -1;
    if (p > occupied) return 100;
    return p < free ? 0 : static_cast<int>(1 + 98 * (p - free) / (occupied - free));
  }
  if (p > occupied) return 100;
  return p < free ? 0 : -1;
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<double> grey, alpha;
};

Pixels pgm_of(const std::string& bytes) {
  std::istringstream header(bytes);
  std::string magic;
  int most = 0;
  Pixels pixels;
  header >> magic >> pixels.width >> pixels.height >> most;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(most, 255);
  const auto start = static_cast<std::size_t>(header.tellg()) + 1;
  EXPECT_EQ(bytes.size(), start + static_cast<std::size_t>(pixels.width * pixels.height));
  for (std::size_t i = start; i < bytes.size(); ++i)
    pixels.grey.push_back(static_cast<unsigned char>(bytes[i]));
  pixels.alpha.assign(pixels.grey.size(), 255);
  return pixels;
}

Pixels png_of(const std::filesystem::path& path) {
  const cv::Mat image = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  Pixels pixels{image.cols, image.rows, {}, {}};
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const bool coloured = image.channels() == 4;
      pixels.grey.push_back(coloured ? image.at<cv::Vec4b>(y, x)[0] : image.at<std::uint8_t>(y, x));
      pixels.alpha.push_back(coloured ? image.at<cv::Vec4b>(y, x)[3] : 255);
    }
  }
  return pixels;
}

OccupancyGrid read_as_map_server(const std::filesystem::path& yaml_path) {
  const auto yaml = yaml_of(yaml_path);
  const auto image = yaml_path.parent_path() / yaml.at("image");
  const Pixels pixels = image.extension() == ".pgm" ? pgm_of(text_of(image)) : png_of(image);
  OccupancyGrid grid;
  grid.resolution = std::stod(yaml.at("resolution"));
  char skip = 0;
  std::istringstream(yaml.at("origin")) >> skip >> grid.origin_x >> skip >> grid.origin_y;
  grid.width = pixels.width;
  grid.height = pixels.height;
  for (int row = pixels.height - 1; row >= 0; --row) {  // the picture's last row is the lowest
    for (int x = 0; x < pixels.width; ++x) {
      const auto at = static_cast<std::size_t>(row * pixels.width + x);
      grid.cells.push_back(interpret(pixels.grey[at], pixels.alpha[at], yaml));
    }
  }
  return grid;
}

int occupancy(CellClass cell) { return cell == CellClass::occupied ? 100 : cell == CellClass::free ? 0 : -1; }

CellClass class_at(const StoredMap& map, CellIndex index, int layer) {
  return classify(Operators::algebraic, cell_in(snapshot_of(map), index, layer), map.info.min_rays);
}

/// Every column of every tile, and one column around them.
template <typename Visit>
void for_each_column(const StoredMap& map, const Visit& visit) {
  const MapArea area = tiled_area(snapshot_of(map));
  for (int y = area.low.y - 1; y <= area.high.y; ++y) {
    for (int x = area.low.x - 1; x <= area.high.x; ++x) visit(CellIndex{x, y});
  }
}

float value_at(const MapSnapshot& map, CellIndex index, std::size_t layer) {
  const Cell cell = cell_in(map, index, static_cast<int>(layer));
  return map_value(Operators::algebraic, mu_E(cell), mu_O(cell),
                   confidence(cell, map.info.full_confidence_rays[layer]));
}

class ExportedPictures : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const StoredMap map_ = random_map(1, {.num_layers = 2, .tiles_per_side = 2});
};

TEST_F(ExportedPictures, RosReadsEveryLayersClassesWhereTheyAre) {
  export_map(ExportFormat::ros, map_, folder_ / "ros");
  for (int layer = 0; layer < 2; ++layer) {
    const auto grid = read_as_map_server(folder_ / ("ros/layer_" + std::to_string(layer) + ".yaml"));
    int wrong = 0;
    for_each_column(map_, [&](CellIndex index) {
      const int seen = grid.at((index.x + 0.5) * kSide, (index.y + 0.5) * kSide);
      wrong += seen != occupancy(class_at(map_, index, layer)) ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0) << "layer " << layer;
  }
}

TEST_F(ExportedPictures, RosReadsFreeOnlyWhereAllLayersAreFreeAndOccupiedWhereOneIs) {
  export_map(ExportFormat::ros, map_, folder_ / "ros");
  const auto grid = read_as_map_server(folder_ / "ros/map.yaml");
  for_each_column(map_, [&](CellIndex index) {
    const int low = occupancy(class_at(map_, index, 0)), high = occupancy(class_at(map_, index, 1));
    const int expected = low == 100 || high == 100 ? 100 : low == 0 && high == 0 ? 0 : -1;
    ASSERT_EQ(grid.at((index.x + 0.5) * kSide, (index.y + 0.5) * kSide), expected)
        << index.x << "," << index.y;
  });
}

TEST_F(ExportedPictures, TrinaryPicturesHoldTheThreeValuesOfMapServer) {
  export_map(ExportFormat::ros, map_, folder_ / "ros");
  const Pixels pixels = pgm_of(text_of(folder_ / "ros/layer_0.pgm"));
  EXPECT_THAT(pixels.grey, ::testing::Each(::testing::AnyOf(0, 205, 254)));
  EXPECT_THAT(pixels.grey, ::testing::IsSupersetOf({0.0, 205.0, 254.0}));
}

TEST_F(ExportedPictures, RosScaleModeRisesWithTheMapValueAndKnowsTheUnknown) {
  export_map(ExportFormat::ros, map_, folder_ / "ros",
             {.rules = {}, .layer = {}, .ros_mode = RosMode::scale});
  const auto grid = read_as_map_server(folder_ / "ros/layer_1.yaml");
  const MapSnapshot snapshot = snapshot_of(map_);
  for_each_column(map_, [&](CellIndex index) {
    const int seen = grid.at((index.x + 0.5) * kSide, (index.y + 0.5) * kSide);
    const double M = value_at(snapshot, index, 1);
    const double scaled = M > 0.65 ? 100 : M < 0.196 ? 0 : 1 + 98 * (M - 0.196) / (0.65 - 0.196);
    const bool known = class_at(map_, index, 1) != CellClass::unknown;
    ASSERT_NEAR(seen, known ? scaled : -1, 2) << index.x << "," << index.y;
  });
}

TEST_F(ExportedPictures, TheWorldFilePutsEveryPixelOnItsCell) {
  export_map(ExportFormat::png, map_, folder_ / "map.png", {.rules = {}, .layer = 1});
  const Pixels pixels = png_of(folder_ / "map.png");
  std::istringstream world(text_of(folder_ / "map.pgw"));
  double dx = 0, rx = 0, ry = 0, dy = 0, x0 = 0, y0 = 0;
  world >> dx >> rx >> ry >> dy >> x0 >> y0;
  EXPECT_EQ(rx, 0);
  EXPECT_EQ(ry, 0);
  const MapSnapshot snapshot = snapshot_of(map_);
  int dark = 0;
  for (int row = 0; row < pixels.height; ++row) {
    for (int column = 0; column < pixels.width; ++column) {
      const CellIndex index = cell_at(map_.info.grid, x0 + column * dx, y0 + row * dy);
      const double grey = pixels.grey[static_cast<std::size_t>(row * pixels.width + column)];
      ASSERT_NEAR(grey, 255 * (1 - value_at(snapshot, index, 1)), 1) << index.x << "," << index.y;
      dark += grey < 128 ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 50);
}

TEST_F(ExportedPictures, AnEmptyMapIsOneUnknownPixel) {
  export_map(ExportFormat::ros, empty_map(1, 1), folder_ / "ros");
  const auto grid = read_as_map_server(folder_ / "ros/map.yaml");
  EXPECT_EQ(grid.cells, std::vector<int>{-1});
  EXPECT_NO_THROW(export_map(ExportFormat::png, empty_map(1, 1), folder_ / "map.png"));
}

TEST_F(ExportedPictures, ALayerThatIsNotThereIsNamed) {
  for (const int layer : {-1, 2}) {
    try {
      export_map(ExportFormat::png, map_, folder_ / "map.png", {.rules = {}, .layer = layer});
      FAIL() << layer;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("layer must be from 0 to 1, got " + std::to_string(layer)));
    }
  }
}

TEST_F(ExportedPictures, OverHttpRosIsATarOfTheSameFiles) {
  const ExportedFile tar = export_bytes(ExportFormat::ros, map_);
  export_map(ExportFormat::ros, map_, folder_ / "ros");
  std::map<std::string, std::string> members;
  std::size_t at = 0;
  while (at + 512 <= tar.bytes.size() && tar.bytes[at] != '\0') {
    const std::string header = tar.bytes.substr(at, 512);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < 512; ++i) {
      sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(header[i]);
    }
    EXPECT_EQ(std::stoul(header.substr(148, 8), nullptr, 8), sum);
    EXPECT_EQ(header.substr(257, 5), "ustar");
    const std::size_t size = std::stoul(header.substr(124, 11), nullptr, 8);
    members[header.c_str()] = tar.bytes.substr(at + 512, size);
    at += 512 + (size + 511) / 512 * 512;
  }
  EXPECT_EQ(tar.bytes.size(), at + 1024);
  EXPECT_EQ(members.size(), 6U);
  for (const auto& [name, bytes] : members) EXPECT_EQ(bytes, text_of(folder_ / ("ros/" + name))) << name;
}

}  // namespace
}  // namespace flogmap::testing
