#include "camera/euroc_source.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "camera/calibration/euroc_calibration.hpp"
#include "camera/csv.hpp"
#include "camera/inertial_up.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

struct TimedFile {
  std::int64_t timestamp_ns;
  fs::path file;
};

/// Why this is no time in nanoseconds.
std::string problem_of(const std::string& time) {
  const bool digits =
      !time.empty() && time.find_first_not_of("0123456789", time[0] == '-' ? 1 : 0) == std::string::npos;
  constexpr std::size_t kShown = 24;
  const std::string shown = time.size() > kShown ? time.substr(0, kShown) + "..." : time;
  return digits ? "time " + shown + " is out of range; allowed: nanoseconds in 64 bits"
                : "not 'timestamp [ns],filename'";
}

/// Nothing is lost by sorting rows that stand in another order; of those of one time the first counts.
void sort_by_time(std::vector<TimedFile>& files, const fs::path& csv, PicturePairList& list) {
  const auto earlier = [](const TimedFile& a, const TimedFile& b) { return a.timestamp_ns < b.timestamp_ns; };
  if (!std::is_sorted(files.begin(), files.end(), earlier)) {
    std::stable_sort(files.begin(), files.end(), earlier);
    list.assumed +=
        (list.assumed.empty() ? "" : "; ") + csv.string() + ": rows were not in order of time and are sorted";
  }
  std::vector<TimedFile> each_once;
  for (TimedFile& file : files) {
    if (!each_once.empty() && file.timestamp_ns == each_once.back().timestamp_ns) {
      list.skip(csv.string() + ": time " + std::to_string(file.timestamp_ns) + " stands there twice");
    } else {
      each_once.push_back(std::move(file));
    }
  }
  files = std::move(each_once);
}

/// The rows of one camera's data.csv in order of time; malformed ones are skipped.
std::vector<TimedFile> list_camera(const fs::path& camera, PicturePairList& list) {
  const fs::path csv = camera / "data.csv";
  std::vector<TimedFile> files;
  std::string problem;
  for (const CsvRow& row : read_csv(csv)) {
    const std::string where = csv.string() + ":" + std::to_string(row.line);
    std::int64_t time = 0;
    if (row.fields.size() < 2 || !parse_number(row.fields[0], time) || row.fields[1].empty()) {
      problem = where + ": " + problem_of(row.fields[0]);
      list.skip(problem);
    } else {
      files.push_back({time, camera / "data" / row.fields[1]});
    }
  }
  if (files.empty())
    throw std::runtime_error(csv.string() + ": lists no pictures" +
                             (problem.empty() ? "" : "; last: " + problem));
  sort_by_time(files, csv, list);
  return files;
}

/// Nearest in time within the tolerance; what has no partner is skipped.
void pair_by_time(const std::vector<TimedFile>& left, const std::vector<TimedFile>& right,
                  PicturePairList& list) {
  constexpr std::int64_t kToleranceNs = 2'000'000;
  constexpr double kMsPerNs = 1e-6;
  std::size_t l = 0, r = 0;
  PairSkew all;
  all.allowed_ms = kMsPerNs * static_cast<double>(kToleranceNs);
  while (l < left.size() || r < right.size()) {
    const bool both = l < left.size() && r < right.size();
    const std::int64_t skew = both ? left[l].timestamp_ns - right[r].timestamp_ns : 0;
    if (both && std::abs(skew) <= kToleranceNs) {
      list.pairs.push_back({left[l].timestamp_ns, left[l].file, right[r].file});
      all.histogram.add(skew);
      ++l, ++r;
    } else if (l < left.size() && (!both || skew < 0)) {
      list.skip(left[l++].file.string() + ": no right picture of that time");
    } else {
      list.skip(right[r++].file.string() + ": no left picture of that time");
    }
  }
  list.skew = all;
}

/// What `flogmap record` noted of a live recording's pairs, whose pictures it lists under one time.
std::optional<PairSkew> captured_skew(const fs::path& capture) {
  if (!fs::is_regular_file(capture)) return std::nullopt;
  PairSkew all;
  for (const CsvRow& row : read_csv(capture)) {
    std::int64_t skew_ns = 0;
    if (row.fields.size() > 1 && parse_number(row.fields[1], skew_ns)) all.histogram.add(skew_ns);
  }
  all.allowed_ms = all.histogram.largest_ms;
  return all.histogram.total() > 0 ? std::optional(all) : std::nullopt;
}

fs::path camera_folder(const fs::path& folder, const char* name) {
  const fs::path base = fs::is_directory(folder / "mav0") ? folder / "mav0" : folder;
  if (!fs::is_directory(base / name)) {
    throw std::runtime_error(folder.string() + ": no folder mav0/" + name + "; the EuRoC layout is expected");
  }
  return base / name;
}

}  // namespace

PicturePairList list_euroc(const fs::path& folder, bool needs_calibration) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  const fs::path cam0 = camera_folder(folder, "cam0"), cam1 = camera_folder(folder, "cam1");
  PicturePairList list;
  if (needs_calibration) {
    list.calibration = read_euroc_pair(cam0 / "sensor.yaml", cam1 / "sensor.yaml");
    list.up_in_left_camera = read_up_in_camera(cam0 / "sensor.yaml");
    if (!list.up_in_left_camera)
      list.up_in_left_camera = inertial_up(cam0.parent_path() / "imu0", list.calibration->body_from_left);
  }
  pair_by_time(list_camera(cam0, list), list_camera(cam1, list), list);
  if (const auto captured = captured_skew(cam0.parent_path() / "capture.csv")) list.skew = captured;
  return list;
}

}  // namespace flogmap
