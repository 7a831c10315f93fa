#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace flogmap {

/// One line that shows how far a long job is: bar, count, rate, time left. Draws on a terminal only;
/// elsewhere it is silent, so that logs stay readable.
class ProgressBar {
 public:
  ProgressBar(std::string job, std::int64_t total);

  /// `done` of the total; `note` stands behind the figures. Redraws at most ten times a second.
  void show(std::int64_t done, const std::string& note);
  /// Leaves the finished line and ends it.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(std::int64_t done, const std::string& note) const;

  const std::string job_;
  const std::int64_t total_;
  const bool on_terminal_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
  std::int64_t done_ = 0;
  std::string note_;
};

}  // namespace flogmap
