#include "server/processor_heat.hpp"

#include <gtest/gtest.h>

#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

class Zones : public ::testing::Test {
 protected:
  void put(const std::string& zone, const std::string& type, const std::string& temp) const {
    folder_.write(zone + "/type", type + "\n");
    folder_.write(zone + "/temp", temp + "\n");
  }
  testing::TemporaryFolder folder_;
};

TEST_F(Zones, TheWarmestSensorOfTheProcessorCounts) {
  put("thermal_zone0", "acpitz", "99000");
  put("thermal_zone1", "cpu-thermal", "48312");
  put("thermal_zone2", "x86_pkg_temp", "51500");
  ProcessorHeat heat(folder_.path());
  EXPECT_DOUBLE_EQ(heat.read().value_or(0), 51.5);
  EXPECT_EQ(heat.warning(), "");
}

TEST_F(Zones, WithoutSensorsNothingIsSaid) {
  put("thermal_zone0", "iwlwifi", "40000");
  EXPECT_FALSE(ProcessorHeat(folder_.path()).read());
  EXPECT_FALSE(ProcessorHeat(folder_.path() / "missing").read());
}

TEST_F(Zones, ASensorThatTalksNonsenseIsPassedOver) {
  for (const char* temp : {"", "hot", "-274000", "4000000", "nan"}) {
    put("thermal_zone0", "cpu-thermal", temp);
    ProcessorHeat heat(folder_.path());
    EXPECT_FALSE(heat.read()) << temp;
    EXPECT_EQ(heat.warning(), "") << temp;
  }
}

TEST_F(Zones, TheWarningStaysUntilItIsClearlyCooler) {
  put("thermal_zone0", "cpu-thermal", "79900");
  ProcessorHeat heat(folder_.path());
  const auto warned_at = [&](const char* temp) {
    put("thermal_zone0", "cpu-thermal", temp);
    heat.read();
    return !heat.warning().empty();
  };
  EXPECT_FALSE(warned_at("79900"));
  EXPECT_TRUE(warned_at("80000"));
  EXPECT_TRUE(warned_at("76000"));
  EXPECT_FALSE(warned_at("74000"));
  EXPECT_FALSE(warned_at("79000"));
}

}  // namespace
}  // namespace flogmap
