#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "server/publication.hpp"

namespace flogmap {

enum class Stage : std::uint8_t { read, rectify, disparity, odometry, map };
inline constexpr std::array<const char*, 5> kStageNames{"read", "rectify", "disparity", "odometry", "map"};

inline double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// How long the stages take: median and 95th percentile of the last `window` values of each, and how many of
/// all fall into which class. Written by the pipeline's threads, read by any.
class StageStatistics {
 public:
  explicit StageStatistics(std::size_t window) : window_(window) {}
  void add(Stage stage, double ms);
  [[nodiscard]] std::vector<StageReport> report() const;

 private:
  struct Samples {
    std::vector<float> ms;  // the last ones
    std::size_t next = 0;
    TimeCounts counts{};  // all
    double total_ms = 0;
  };
  const std::size_t window_;
  mutable std::mutex mutex_;
  std::array<Samples, kStageNames.size()> samples_;
};

}  // namespace flogmap
