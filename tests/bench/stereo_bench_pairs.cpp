#include "tests/bench/stereo_bench_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "camera/picture_files.hpp"
#include "camera/rectifier.hpp"
#include "camera/source_spec.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Picture read(const fs::path& file) {
  ReadPicture read = read_picture(file);
  if (!read.problem.empty()) throw std::runtime_error(read.problem);
  return std::move(read.picture);
}

/// A pair that is rectified already, as the program would take it.
RectifiedFrame rectified(const Picture& left, const Picture& right, std::int64_t timestamp_ns = 0) {
  StereoCalibration calibration;
  calibration.left.width_px = left.width;
  calibration.left.height_px = left.height;
  calibration.left.fx_px = calibration.left.fy_px = 1;
  calibration.right = calibration.left;
  calibration.right_from_left.translation().x() = -1;
  calibration.rectified = true;
  return Rectifier(calibration).rectify({timestamp_ns, left, right});
}

struct Middlebury {
  const char* name;
  float scale;  // grey levels per pixel of disparity
  int num_disparities;
};

/// Disparity of a truth picture, whose 0 means unknown.
Image<float> read_disparity(const fs::path& file, float scale) {
  const Picture picture = read(file);
  Image<float> out(picture.width, picture.height, kUnknown);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int grey = picture.bytes[i * picture.channels];
    if (grey > 0) out.pixels[i] = static_cast<float>(grey) / scale;
  }
  return out;
}

/// A point is visible if the right picture's truth says the same of it.
Image<std::uint8_t> visible_in_both(const Image<float>& left, const Image<float>& right) {
  Image<std::uint8_t> out(left.width, left.height, 0);
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      if (std::isnan(left.at(x, y))) continue;
      const int right_x = static_cast<int>(std::lround(static_cast<float>(x) - left.at(x, y)));
      out.at(x, y) = right_x >= 0 && std::abs(right.at(right_x, y) - left.at(x, y)) <= 1;
    }
  }
  return out;
}

BenchPair load_middlebury(const fs::path& folder, const Middlebury& set) {
  BenchPair pair{.name = set.name, .num_disparities = set.num_disparities};
  pair.frame = rectified(read(folder / set.name / "im2.png"), read(folder / set.name / "im6.png"));
  pair.truth = read_disparity(folder / set.name / "disp2.png", set.scale);
  pair.visible = Image<std::uint8_t>(pair.truth.width, pair.truth.height, 1);
  const fs::path right = folder / set.name / "disp6.png";
  if (fs::exists(right)) pair.visible = visible_in_both(pair.truth, read_disparity(right, set.scale));
  return pair;
}

/// Depth in metres, rows from the bottom up.
Image<float> read_pfm(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string magic;
  int width = 0, height = 0;
  double scale = 0;
  in >> magic >> width >> height >> scale;
  in.get();
  Image<float> out(std::max(width, 0), std::max(height, 0));
  for (int y = height - 1; y >= 0; --y) {
    in.read(reinterpret_cast<char*>(out.row(y)), static_cast<std::streamsize>(width * sizeof(float)));
  }
  if (!in || magic != "Pf") throw std::runtime_error(file.string() + ": not a PFM file of one channel");
  return out;
}

/// Visible unless it lies outside the right picture or something nearer lands on it there.
bool seen_by_right(const Image<float>& truth, int x, int y, int reach) {
  const float d = truth.at(x, y), right_x = static_cast<float>(x) - d;
  if (right_x < 0) return false;
  for (int u = x + 1; u < std::min(truth.width, x + reach); ++u) {
    if (truth.at(u, y) > d + 1 && static_cast<float>(u) - truth.at(u, y) <= right_x + 0.5F) return false;
  }
  return true;
}

BenchPair load_rendered(const StereoFrame& frame, const StereoCamera& camera, const fs::path& depth,
                        int reach) {
  BenchPair pair{.frame = rectified(frame.left, frame.right), .num_disparities = reach, .camera = camera};
  pair.truth = read_pfm(depth);
  for (float& z : pair.truth.pixels) {
    z = z > 0 && std::isfinite(z) ? static_cast<float>(camera.focal_px * camera.baseline_m) / z : kUnknown;
  }
  pair.visible = Image<std::uint8_t>(pair.truth.width, pair.truth.height, 0);
  for (int y = 0; y < pair.truth.height; ++y) {
    for (int x = 0; x < pair.truth.width; ++x) pair.visible.at(x, y) = seen_by_right(pair.truth, x, y, reach);
  }
  return pair;
}

/// Every frame of a rendered recording that has a true depth.
void add_rendered(const fs::path& folder, const std::string& name, int reach, std::vector<BenchPair>& pairs) {
  const auto source = open_source({.spec = "euroc:" + folder.string()});
  const StereoCamera camera = Rectifier(*source->calibration()).camera();
  int count = 0;
  while (const auto frame = source->next()) {
    const fs::path depth = folder / "depth" / (std::to_string(frame->timestamp_ns) + ".pfm");
    if (!fs::exists(depth)) continue;
    pairs.push_back(load_rendered(*frame, camera, depth, reach));
    pairs.back().name = name + std::to_string(count++);
  }
}

BenchPair load_real(const std::string& spec, const std::string& name, int num_disparities) {
  const auto source = open_source({.spec = spec});
  const Rectifier rectifier(*source->calibration());
  const auto frame = source->next();
  if (!frame) throw std::runtime_error(spec + ": has no frame");
  return {.name = name,
          .frame = rectifier.rectify(*frame),
          .num_disparities = num_disparities,
          .camera = rectifier.camera()};
}

}  // namespace

std::vector<BenchPair> load_bench_pairs(const fs::path& data) {
  std::vector<BenchPair> pairs;
  for (const Middlebury& set :
       {Middlebury{"teddy", 4, 64}, Middlebury{"cones", 4, 64}, Middlebury{"tsukuba", 16, 16},
        Middlebury{"barn2", 8, 32}, Middlebury{"bull", 8, 32}, Middlebury{"sawtooth", 8, 32}}) {
    pairs.push_back(load_middlebury(data / "middlebury", set));
  }
  add_rendered(data / "house-dev", "house", 112, pairs);
  add_rendered(data / "two-boxes-near", "boxes", 64, pairs);
  pairs.push_back(load_real("euroc:" + (data / "euroc_mh01_10hz").string(), "mh01_64", 64));
  pairs.push_back(load_real("euroc:" + (data / "euroc_mh01_10hz").string(), "mh01_96", 96));
  pairs.push_back(load_real("kitti:" + (data / "kitti03").string(), "kitti03", 128));
  return pairs;
}

}  // namespace flogmap
