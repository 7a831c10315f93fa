#include "camera/inertial_up.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include "camera/calibration/euroc_calibration.hpp"
#include "camera/csv.hpp"

namespace flogmap {
namespace {

std::vector<Acceleration> read_start(const std::filesystem::path& csv) {
  constexpr double kStartS = 2.5;
  std::vector<Acceleration> samples;
  std::int64_t first = 0;
  for (const CsvRow& row : read_csv(csv)) {
    std::int64_t time = 0;
    Eigen::Vector3d a;
    if (row.fields.size() < 7 || !parse_number(row.fields[0], time) || !parse_number(row.fields[4], a.x()) ||
        !parse_number(row.fields[5], a.y()) || !parse_number(row.fields[6], a.z())) {
      continue;  // a bad row of an aid: the others say enough
    }
    if (samples.empty()) first = time;
    const double seconds = 1e-9 * static_cast<double>(time - first);
    if (seconds > kStartS) break;
    samples.push_back({seconds, a});
  }
  return samples;
}

Eigen::Vector3d mean_until(const std::vector<Acceleration>& samples, double end_s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Acceleration& sample : samples) {
    if (sample.time_s > end_s) break;
    sum += sample.in_sensor;
    ++count;
  }
  return sum / count;
}

}  // namespace

std::optional<Eigen::Vector3d> resting_acceleration(const std::vector<Acceleration>& samples) {
  constexpr double kFirstS = 0.5, kLongestS = 2.0, kRestingSpread = 1.0, kGravity = 9.81, kGravitySlack = 0.5;
  if (samples.empty() || samples.back().time_s < kFirstS) return std::nullopt;
  const Eigen::Vector3d first = mean_until(samples, kFirstS);
  double rest_until_s = 0;
  for (const Acceleration& sample : samples) {
    if (sample.time_s > kLongestS || (sample.in_sensor - first).norm() > kRestingSpread) break;
    rest_until_s = sample.time_s;
  }
  const Eigen::Vector3d mean = mean_until(samples, rest_until_s);
  if (rest_until_s < kFirstS || std::abs(mean.norm() - kGravity) > kGravitySlack) return std::nullopt;
  return mean;
}

std::optional<Eigen::Vector3d> inertial_up(const std::filesystem::path& imu_folder,
                                           const Eigen::Isometry3d& body_from_left) {
  if (!std::filesystem::exists(imu_folder / "data.csv")) return std::nullopt;
  const auto acceleration = resting_acceleration(read_start(imu_folder / "data.csv"));
  if (!acceleration) return std::nullopt;
  const Eigen::Isometry3d body_from_imu = read_euroc_extrinsics(imu_folder / "sensor.yaml");
  // At rest an accelerometer feels the support against gravity: it points up.
  return Eigen::Vector3d(body_from_left.linear().transpose() * body_from_imu.linear() * *acceleration)
      .normalized();
}

}  // namespace flogmap
