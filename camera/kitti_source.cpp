#include "camera/kitti_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "camera/calibration/kitti_calibration.hpp"
#include "camera/csv.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kPeriodNs = 100'000'000;  // where no file says the times

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

/// Seconds since the start, one a line; nothing if there is no such file.
std::vector<double> read_times(const fs::path& file) {
  std::vector<double> times;
  if (!fs::exists(file)) return times;
  for (const CsvRow& row : read_csv(file)) {
    double seconds = 0;
    if (!parse_number(row.fields[0], seconds) || std::abs(seconds) > 4e9) {
      throw std::runtime_error(file.string() + ":" + std::to_string(row.line) + ": must be seconds, got '" +
                               row.fields[0] + "'");
    }
    times.push_back(seconds);
  }
  return times;
}

fs::path calibration_file(const fs::path& folder) {
  for (const fs::path& file : {folder / "calib.txt", folder / "calib_cam_to_cam.txt",
                               folder.parent_path() / "calib_cam_to_cam.txt"}) {
    if (fs::exists(file)) return file;
  }
  throw std::runtime_error(folder.string() + ": no calib.txt or calib_cam_to_cam.txt");
}

void list_pairs(const fs::path& folder, const Layout& layout, PicturePairList& list) {
  const std::set<std::string> left = picture_names(folder / layout.left),
                              right = picture_names(folder / layout.right);
  const std::vector<double> times = read_times(folder / "times.txt");
  std::size_t index = 0;
  for (const std::string& name : left) {
    const std::size_t i = index++;
    const fs::path file = folder / layout.left / name;
    if (!times.empty() && i >= times.size()) {
      list.skip(file.string() + ": no time in times.txt");
      continue;
    }
    const std::int64_t time_ns =
        times.empty() ? static_cast<std::int64_t>(i) * kPeriodNs : std::llround(1e9 * times[i]);
    if (!list.pairs.empty() && time_ns <= list.pairs.back().timestamp_ns) {
      list.skip((folder / "times.txt").string() + ":" + std::to_string(i + 1) + ": time does not increase");
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

PicturePairList list_kitti(const fs::path& folder, bool needs_calibration) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  const auto* layout = std::find_if(kLayouts.begin(), kLayouts.end(), [&](const Layout& candidate) {
    return fs::is_directory(folder / candidate.left) && fs::is_directory(folder / candidate.right);
  });
  if (layout == kLayouts.end()) {
    throw std::runtime_error(folder.string() +
                             ": no folders image_0 and image_1 (or image_2 and image_3); the KITTI "
                             "layout is expected");
  }
  PicturePairList list;
  if (needs_calibration) {
    list.calibration = read_kitti_pair(calibration_file(folder), layout->left_number, layout->right_number);
  }
  list_pairs(folder, *layout, list);
  return list;
}

}  // namespace flogmap
