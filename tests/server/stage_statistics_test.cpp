#include "server/stage_statistics.hpp"

#include <gtest/gtest.h>

namespace flogmap {
namespace {

TEST(StageStatistics, MedianAndPercentileOfKnownValues) {
  StageStatistics statistics(1000);
  for (int i = 100; i >= 0; --i) statistics.add(Stage::disparity, i);
  const StageReport report = statistics.report()[2];
  EXPECT_EQ(report.stage, "disparity");
  EXPECT_DOUBLE_EQ(report.median_ms, 50);
  EXPECT_DOUBLE_EQ(report.p95_ms, 95);
}

TEST(StageStatistics, OldValuesLeaveTheWindow) {
  StageStatistics statistics(4);
  for (int i = 0; i < 100; ++i) statistics.add(Stage::map, 1000);
  for (int i = 0; i < 4; ++i) statistics.add(Stage::map, 2);
  EXPECT_DOUBLE_EQ(statistics.report()[4].p95_ms, 2);
}

TEST(StageStatistics, StagesWithoutValuesReportZero) {
  for (const StageReport& report : StageStatistics(8).report()) {
    EXPECT_EQ(report.median_ms, 0);
    EXPECT_EQ(report.p95_ms, 0);
  }
}

}  // namespace
}  // namespace flogmap
