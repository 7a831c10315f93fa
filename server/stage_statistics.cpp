#include "server/stage_statistics.hpp"

#include <algorithm>

namespace flogmap {
namespace {

double percentile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(place)]);
}

}  // namespace

void StageStatistics::add(Stage stage, double ms) {
  const std::scoped_lock lock(mutex_);
  Samples& samples = samples_[static_cast<std::size_t>(stage)];
  const auto time_class = std::lower_bound(kTimeClassesMs.begin(), kTimeClassesMs.end(), ms);
  ++samples.counts[static_cast<std::size_t>(time_class - kTimeClassesMs.begin())];
  samples.total_ms += ms;
  if (samples.ms.size() < window_) {
    samples.ms.push_back(static_cast<float>(ms));
    return;
  }
  samples.ms[samples.next] = static_cast<float>(ms);
  samples.next = (samples.next + 1) % window_;
}

std::vector<StageReport> StageStatistics::report() const {
  std::vector<StageReport> reports;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    Samples samples;
    {
      const std::scoped_lock lock(mutex_);
      samples = samples_[i];
    }
    const double median_ms = percentile(samples.ms, 0.5), p95_ms = percentile(samples.ms, 0.95);
    reports.push_back({kStageNames[i], median_ms, p95_ms, samples.counts, samples.total_ms});
  }
  return reports;
}

}  // namespace flogmap
