#include "mapping/flog/map_value.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace flogmap {
namespace {

constexpr Operators kEvery[] = {Operators::algebraic, Operators::minmax, Operators::lukasiewicz};

Operators named(const std::string& name) {
  if (name == "minmax") return Operators::minmax;
  return name == "lukasiewicz" ? Operators::lukasiewicz : Operators::algebraic;
}

TEST(MapValue, AgreesWithTheGoldenValuesThatThePageSharesWithUs) {
  std::ifstream file(FLOGMAP_SOURCE_DIR "/tests/golden/map_values.json");
  const auto values = nlohmann::json::parse(file);
  ASSERT_GT(values.size(), 300U);
  for (const auto& row : values) {
    const Operators operators = named(row["operators"]);
    const float E = row["E"], O = row["O"], K = row["K"];
    EXPECT_NEAR(map_value(operators, E, O, K), row["M"].get<float>(), 1e-6) << row;
    EXPECT_NEAR(planning_value(operators, O, K), row["M_p"].get<float>(), 1e-6) << row;
    EXPECT_NEAR(motion_value(operators, E, O, K), row["M_m"].get<float>(), 1e-6) << row;
    EXPECT_NEAR(conflict_value(E, O, K), row["conflict"].get<float>(), 1e-6) << row;
  }
}

struct Row {
  float E, O, K, minmax, algebraic, lukasiewicz;
};

TEST(MapValue, IsTheTableOfTheSpecification) {
  const Row rows[] = {{0, 0, 0, 0, 0, 0},           {1, 0, 1, 0, 0, 0},
                      {0, 1, 1, 1, 1, 1},           {0, 1, .2F, .2F, .2F, .2F},
                      {.5F, .5F, 1, .5F, .562F, 1}, {.8F, .2F, 1, .2F, .302F, .4F},
                      {.2F, .8F, 1, .8F, .806F, 1}, {0, .5F, 1, .5F, .5F, .5F}};
  for (const Row& row : rows) {
    EXPECT_NEAR(map_value(Operators::minmax, row.E, row.O, row.K), row.minmax, 6e-4);
    EXPECT_NEAR(map_value(Operators::algebraic, row.E, row.O, row.K), row.algebraic, 6e-4);
    EXPECT_NEAR(map_value(Operators::lukasiewicz, row.E, row.O, row.K), row.lukasiewicz, 6e-4);
  }
}

TEST(MapValue, ConfidenceStandsOutsideTheComplement) {
  // Inside, a free cell would be worth 1 - K; it must be worth nothing however little it is known.
  for (const Operators operators : kEvery) EXPECT_EQ(map_value(operators, 1, 0, 0.1F), 0);
}

TEST(MapValue, SafeMapsTakeTheUnknownForFreeAndForOccupied) {
  for (const Operators operators : kEvery) {
    EXPECT_EQ(planning_value(operators, 0, 0), 0);
    EXPECT_EQ(motion_value(operators, 0, 0, 0), 1);
    EXPECT_EQ(motion_value(operators, 1, 0, 1), 0);
    EXPECT_EQ(motion_value(operators, 0, 1, 1), 1);
  }
  EXPECT_NEAR(motion_value(Operators::algebraic, 1, 0, 0.2F), 0.96F, 1e-6F);
}

TEST(MapValue, ClassesNeedEnoughRaysButNoConfidence) {
  const Cell occupied{10'000, 50'000, 8, 0}, free{65'535, 0, 8, 0}, hardly_seen{10'000, 50'000, 7, 0};
  EXPECT_EQ(classify(Operators::algebraic, occupied, 8), CellClass::occupied);
  EXPECT_EQ(classify(Operators::algebraic, free, 8), CellClass::free);
  EXPECT_EQ(classify(Operators::algebraic, hardly_seen, 8), CellClass::unknown);
}

}  // namespace
}  // namespace flogmap
