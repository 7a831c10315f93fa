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

/// Mean over [begin_s, end_s); nothing if there is no sample.
std::optional<Eigen::Vector3d> mean(const std::vector<Acceleration>& samples, double begin_s, double end_s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Acceleration& sample : samples) {
    if (sample.time_s < begin_s || sample.time_s >= end_s) continue;
    sum += sample.in_sensor;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

}  // namespace

std::optional<Eigen::Vector3d> resting_acceleration(const std::vector<Acceleration>& samples) {
  constexpr double kFirstS = 0.5, kBlockS = 0.1;
  constexpr int kMostBlocks = 20, kLeastBlocks = 5;
  constexpr double kRestingMs2 = 0.4, kGravityMs2 = 9.81, kGravitySlackMs2 = 0.5;
  const auto first = mean(samples, 0, kFirstS);
  if (!first || samples.back().time_s < kFirstS) return std::nullopt;
  int num_blocks = 0;
  for (; num_blocks < kMostBlocks; ++num_blocks) {  // block by block: motors shake single samples
    const auto block = mean(samples, kBlockS * num_blocks, kBlockS * (num_blocks + 1));
    if (!block || (*block - *first).norm() > kRestingMs2) break;
  }
  if (num_blocks < kLeastBlocks) return std::nullopt;
  const auto resting = mean(samples, 0, kBlockS * num_blocks);
  return std::abs(resting->norm() - kGravityMs2) < kGravitySlackMs2 ? resting : std::nullopt;
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
