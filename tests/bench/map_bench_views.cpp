#include "map_bench_views.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "tests/support/box_scene.hpp"
#include "tests/support/recordings.hpp"

namespace flogmap {
namespace {

/// Portable float map, one channel, little-endian, bottom row first.
Image<float> read_pfm(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  int width = 0, height = 0;
  double scale = 0;
  file >> magic >> width >> height >> scale;
  file.get();
  if (magic != "Pf" || width <= 0 || height <= 0 || scale >= 0)
    throw std::runtime_error(path.string() + ": no PFM");
  Image<float> image(width, height);
  std::vector<char> row(std::size_t(width) * sizeof(float));
  for (int y = height - 1; y >= 0; --y) {
    if (!file.read(row.data(), static_cast<std::streamsize>(row.size()))) {
      throw std::runtime_error(path.string() + ": too short");
    }
    std::memcpy(image.row(y), row.data(), row.size());
  }
  return image;
}

/// The pose of a TUM trajectory whose time is nearest.
SE3 pose_at(const std::filesystem::path& path, double time_s) {
  std::ifstream file(path);
  SE3 nearest = SE3::Identity();
  double least = 1e300;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    double t = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    if (!(fields >> t >> x >> y >> z >> qx >> qy >> qz >> qw) || std::abs(t - time_s) >= least) continue;
    least = std::abs(t - time_s);
    nearest.translation() = Eigen::Vector3d(x, y, z);
    nearest.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
  }
  return nearest;
}

}  // namespace

BenchViews room_views(int count) {
  BenchViews bench{"room", {435, 375.5, 239.5, 0.11, 752, 480}, {}};
  std::mt19937 random(1);
  std::normal_distribution<double> tremor(0, 0.08);
  for (int i = 0; i < count; ++i) {
    const double along = 2 * std::numbers::pi * i / count;
    const Eigen::Vector3d place(-1.2 + 1.2 * std::cos(along), 1.0 * std::sin(along), 1.3 + tremor(random));
    const SE3 pose = test::looking(place, along + 2.5, -0.1 + tremor(random), tremor(random));
    bench.views.push_back(test::seen_from(test::furnished_room(), bench.camera, pose));
  }
  return bench;
}

BenchViews house_views() {
  BenchViews bench{"house", {417, 319.5, 239.5, 0.12, 640, 480}, {}};
  const auto folder = recording("house-dev");
  if (!folder) return bench;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(*folder / "depth"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    View view;
    view.timestamp_ns = std::stoll(file.stem().string());
    view.world_from_camera =
        pose_at(*folder / "groundtruth.tum", static_cast<double>(view.timestamp_ns) * 1e-9);
    view.disparity.px = read_pfm(file);
    for (float& z : view.disparity.px.pixels)
      z = static_cast<float>(bench.camera.focal_px * bench.camera.baseline_m) / z;
    bench.views.push_back(std::move(view));
  }
  return bench;
}

}  // namespace flogmap
