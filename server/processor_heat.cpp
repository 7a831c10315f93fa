#include "server/processor_heat.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

namespace flogmap {
namespace {

constexpr double kHot_c = 80;
constexpr double kCool_c = 75;  // a warning that comes and goes every second would fill the log

/// As drivers call them: "cpu-thermal" (Raspberry Pi and most boards), "x86_pkg_temp", "soc_thermal".
bool is_of_processor(std::string_view type) {
  constexpr std::array<std::string_view, 3> kNames{"cpu", "x86_pkg_temp", "soc"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view name) { return type.find(name) != std::string_view::npos; });
}

/// The kernel gives thousandths of a degree; a sensor that is switched off gives an error or nonsense.
std::optional<double> celsius_of(const std::filesystem::path& sensor) {
  double milli = 0;
  if (!(std::ifstream(sensor) >> milli) || milli < -50e3 || milli > 200e3) return std::nullopt;
  return milli / 1000;
}

}  // namespace

ProcessorHeat::ProcessorHeat(const std::filesystem::path& zones) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(zones, error), end; !error && at != end; at.increment(error)) {
    std::string type;
    std::getline(std::ifstream(at->path() / "type"), type);
    if (is_of_processor(type)) sensors_.push_back(at->path() / "temp");
  }
}

std::optional<double> ProcessorHeat::read() {
  std::optional<double> warmest;
  for (const std::filesystem::path& sensor : sensors_) {
    const std::optional<double> celsius = celsius_of(sensor);
    if (celsius && (!warmest || *celsius > *warmest)) warmest = celsius;
  }
  hot_ = warmest && *warmest >= (hot_ ? kCool_c : kHot_c);
  return warmest;
}

std::string ProcessorHeat::warning() const {
  return hot_ ? "the processor is hotter than 80 degrees and slows itself down: give it air or less to do"
              : "";
}

}  // namespace flogmap
