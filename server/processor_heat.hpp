#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flogmap {

/// How warm the processor is, as the system tells it. Small computers in the sun slow themselves down at
/// about 80 degrees, and then frames are dropped for no reason that could be seen elsewhere.
class ProcessorHeat {
 public:
  /// `zones`: the folder of the kernel's thermal zones.
  explicit ProcessorHeat(const std::filesystem::path& zones = "/sys/class/thermal");

  /// Reads the sensors: the warmest of the processor's, degrees Celsius; nothing where there is none, as in
  /// most virtual machines.
  std::optional<double> read();

  /// In words, with what to do, while it was too warm at the last reading; else empty.
  [[nodiscard]] std::string warning() const;

 private:
  std::vector<std::filesystem::path> sensors_;
  bool hot_ = false;
};

}  // namespace flogmap
