#include "camera/kitti_source.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "camera/calibration/kitti_calibration.hpp"
#include "camera/kitti_oxts.hpp"
#include "camera/kitti_times.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

struct Layout {
  const char *left, *right;
  int left_number, right_number;
};

constexpr std::array kLayouts{Layout{"image_0", "image_1", 0, 1}, Layout{"image_2", "image_3", 2, 3},
                              Layout{"image_00/data", "image_01/data", 0, 1},
                              Layout{"image_02/data", "image_03/data", 2, 3}};

std::set<std::string> picture_names(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".png") || name.ends_with(".jpg") || name.ends_with(".pgm")) names.insert(name);
  }
  return names;
}

/// times.txt of an odometry sequence, timestamps.txt of a raw drive's camera.
fs::path times_file(const fs::path& folder, const Layout& layout) {
  const fs::path raw = (folder / layout.left).parent_path() / "timestamps.txt";
  return fs::exists(raw) ? raw : folder / "times.txt";
}

fs::path calibration_file(const fs::path& folder) {
  for (const fs::path& file : {folder / "calib.txt", folder / "calib_cam_to_cam.txt",
                               folder.parent_path() / "calib_cam_to_cam.txt"}) {
    if (fs::exists(file)) return file;
  }
  throw std::runtime_error(folder.string() + ": no calib.txt or calib_cam_to_cam.txt");
}

void list_pairs(const fs::path& folder, const Layout& layout, double rate_hz, PicturePairList& list) {
  const std::set<std::string> left = picture_names(folder / layout.left),
                              right = picture_names(folder / layout.right);
  const fs::path said = times_file(folder, layout);
  const std::vector<std::int64_t> times = read_kitti_times(said);
  if (times.empty()) list.assumed = said.string() + ": not there; " + assumed_rate(rate_hz);
  const std::vector<std::size_t> lines = kitti_lines({left.begin(), left.end()}, times.size());
  std::size_t place = 0;
  for (const std::string& name : left) {
    const std::size_t line = lines[place++];
    const fs::path file = folder / layout.left / name;
    if (!times.empty() && line >= times.size()) {
      list.skip(file.string() + ": no time in " + said.filename().string());
      continue;
    }
    const std::int64_t time_ns = times.empty() ? time_at(line, rate_hz) : times[line];
    if (!list.pairs.empty() && time_ns <= list.pairs.back().timestamp_ns) {
      list.skip(said.string() + ":" + std::to_string(line + 1) + ": time does not increase");
    } else if (!right.contains(name)) {
      list.skip(file.string() + ": no right picture of that name");
    } else {
      list.pairs.push_back({time_ns, file, folder / layout.right / name});
    }
  }
  for (const std::string& name : right) {
    if (!left.contains(name))
      list.skip((folder / layout.right / name).string() + ": no left picture of that name");
  }
}

}  // namespace

PicturePairList list_kitti(const fs::path& folder, bool needs_calibration, double rate_hz) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  const auto* layout = std::find_if(kLayouts.begin(), kLayouts.end(), [&](const Layout& candidate) {
    return fs::is_directory(folder / candidate.left) && fs::is_directory(folder / candidate.right);
  });
  if (layout == kLayouts.end()) {
    throw std::runtime_error(folder.string() +
                             ": no folders image_0 and image_1 (or image_2 and image_3); the KITTI "
                             "layout is expected, or a raw drive with image_00/data and image_01/data");
  }
  PicturePairList list;
  if (needs_calibration) {
    const fs::path calibration = calibration_file(folder);
    list.calibration = read_kitti_pair(calibration, layout->left_number, layout->right_number);
    list.up_in_left_camera = kitti_up(folder / "oxts", calibration.parent_path());
  }
  list_pairs(folder, *layout, rate_hz, list);
  return list;
}

}  // namespace flogmap
