#include "mapping/flog/map_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "mapping/flog/map_planes.hpp"
#include "tests/mapping/flog/map_canvas.hpp"

namespace flogmap {
namespace {

using test::kFreeCell;
using test::kOccupiedCell;
using test::MapCanvas;

std::uint8_t at(const MapPicture& picture, CellIndex cell) {
  return picture.grey.at(picture.pixel_x(cell), picture.pixel_y(cell));
}

TEST(MapPicture, IsNorthUpAndDarkWhereOccupied) {
  MapCanvas canvas;
  canvas.set({-3, 70}, 1, kOccupiedCell);
  canvas.set({5, -2}, 0, kFreeCell);
  const MapArea area = seen_area(canvas.map());
  EXPECT_EQ(area, (MapArea{{-3, -2}, {6, 71}}));
  const MapPicture picture = map_picture(canvas.map(), area, std::nullopt, {});
  EXPECT_EQ(picture.grey.at(0, 0), 0);     // highest y, lowest x
  EXPECT_EQ(picture.grey.at(8, 72), 255);  // lowest y, highest x
  EXPECT_DOUBLE_EQ(picture.origin_x_m(), -0.06);
  EXPECT_DOUBLE_EQ(picture.origin_y_m(), -0.04);
  EXPECT_EQ(map_picture(canvas.map(), area, 0, {}).grey.at(0, 0), 255);  // another layer
}

TEST(MapPicture, FusesByTheLargestOfTheLayersThatMeetTheRobot) {
  MapCanvas canvas;
  canvas.set({1, 1}, 2, kOccupiedCell);
  Rules rules;
  const MapArea area{{0, 0}, {4, 4}};
  EXPECT_EQ(at(map_picture(canvas.map(), area, std::nullopt, rules), {1, 1}), 0);
  rules.heights = {0, 1.45};  // below layer 2
  EXPECT_EQ(at(map_picture(canvas.map(), area, std::nullopt, rules), {1, 1}), 255);
}

TEST(MapPicture, MotionTakesUnseenGroundForOccupiedAndPlanningForFree) {
  const MapArea area{{0, 0}, {4, 4}};
  MapCanvas canvas;
  Rules rules;
  rules.style = Style::motion;
  EXPECT_EQ(at(map_picture(canvas.map(), area, std::nullopt, rules), {1, 1}), 0);
  rules.style = Style::planning;
  EXPECT_EQ(at(map_picture(canvas.map(), area, std::nullopt, rules), {1, 1}), 255);
}

TEST(MapPicture, GrowsObstaclesByTheRobotsRadiusAcrossTilesAndFromOutside) {
  MapCanvas canvas;
  canvas.set({63, 10}, 0, kOccupiedCell);
  Rules rules;
  rules.robot_radius_m = 0.1;  // five cells
  const MapArea area{{64, 0}, {80, 20}};
  const MapPicture picture = map_picture(canvas.map(), area, std::nullopt, rules);
  for (int x = area.low.x; x < area.high.x; ++x) {
    for (int y = area.low.y; y < area.high.y; ++y) {
      const bool near = std::hypot(x - 63, y - 10) <= 5;
      EXPECT_EQ(at(picture, {x, y}), near ? 0 : 255) << x << " " << y;
    }
  }
}

TEST(MapPicture, APartOfALargerPictureIsThePictureOfThatPart) {
  MapCanvas canvas;
  canvas.set({63, 10}, 0, kOccupiedCell);
  canvas.set({-3, -60}, 1, kFreeCell);
  const MapArea whole{{-300, -200}, {250, 260}};  // tiles are only about its middle
  for (const Style style : {Style::visual, Style::motion, Style::planning}) {
    Rules rules;
    rules.style = style;
    rules.robot_radius_m = 0.1;
    const MapPicture picture = map_picture(canvas.map(), whole, std::nullopt, rules);
    for (const MapArea& part : {MapArea{{60, 0}, {70, 15}},
                                {{-66, -70}, {-60, -60}},
                                {{200, 200}, {210, 210}},
                                {{120, -5}, {140, 90}}}) {
      const MapPicture alone = map_picture(canvas.map(), part, std::nullopt, rules);
      for (int x = part.low.x; x < part.high.x; ++x) {
        for (int y = part.low.y; y < part.high.y; ++y)
          EXPECT_EQ(at(alone, {x, y}), at(picture, {x, y})) << x << " " << y;
      }
    }
  }
}

TEST(MapPicture, TrinaryCallsFreeOnlyWhatIsFreeAtEveryHeight) {
  MapCanvas canvas;
  for (int layer = 0; layer < 3; ++layer) canvas.set({0, 0}, layer, kFreeCell);
  canvas.set({1, 0}, 0, kFreeCell);
  canvas.set({2, 0}, 2, kOccupiedCell);
  const MapArea area{{0, 0}, {4, 1}};
  const MapPicture all = trinary_picture(canvas.map(), area, std::nullopt, {});
  EXPECT_EQ(at(all, {0, 0}), kTrinaryFree);
  EXPECT_EQ(at(all, {1, 0}), kTrinaryUnknown);
  EXPECT_EQ(at(all, {2, 0}), kTrinaryOccupied);
  EXPECT_EQ(at(all, {3, 0}), kTrinaryUnknown);
  EXPECT_EQ(at(trinary_picture(canvas.map(), area, 0, {}), {1, 0}), kTrinaryFree);
}

TEST(MapPicture, RefusesToBeEnormous) {
  const MapArea area{{0, 0}, {1 << 29, 1 << 29}};
  EXPECT_THROW(map_picture(MapCanvas().map(), area, std::nullopt, {}), std::length_error);
}

TEST(SpreadLargest, EqualsBruteForce) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> grey(0, 255);
  Image<std::uint8_t> image(37, 23);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(grey(random) > 250 ? grey(random) : 0);
  for (const double radius : {0.5, 1.0, 1.5, 4.3, 9.0}) {
    const Image<std::uint8_t> spread = spread_largest(image, radius);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        std::uint8_t largest = 0;
        for (int v = 0; v < image.height; ++v) {
          for (int u = 0; u < image.width; ++u) {
            if (std::hypot(u - x, v - y) <= radius) largest = std::max(largest, image.at(u, v));
          }
        }
        ASSERT_EQ(spread.at(x, y), largest) << radius;
      }
    }
  }
}

TEST(MapPlanes, HoldEveryStyleOfACell) {
  MapCanvas canvas;
  canvas.set({5, 0}, 1, Cell{32768, 16384, 50, 6554});
  const Tile& tile = *canvas.map().tiles.begin()->second;
  const auto shown = [&](Style style) {
    Rules rules;
    rules.style = style;
    return value_plane(tile, canvas.map().info, 1, rules).at(5, 0);
  };
  EXPECT_EQ(shown(Style::empty), 128);
  EXPECT_EQ(shown(Style::confidence), 128);
  EXPECT_EQ(shown(Style::planning), 32);  // 0.25 * 0.5
  EXPECT_EQ(shown(Style::conflict), 64);  // 2 * 0.25 * 0.5
  EXPECT_EQ(shown(Style::changed), 26);
  EXPECT_EQ(shown(Style::visual), 50);  // (1 - 0.375) (1 - 0.375) 0.5 = 0.1953
}

}  // namespace
}  // namespace flogmap
