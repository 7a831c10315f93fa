#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/odometry/trajectory_error.hpp"

namespace flogmap {
namespace {

enum class Kind { tum, euroc, kitti };

/// A line of a file, for messages.
struct Line {
  const std::filesystem::path& file;
  int number = 0;
  std::string text;
};

[[noreturn]] void fail(const Line& line, const std::string& what) {
  throw std::runtime_error(line.file.string() + ":" + std::to_string(line.number) + ": " + what);
}

std::string quoted(std::string_view word) { return std::string("'").append(word).append("'"); }

bool is_comment(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos || text[first] == '#';
}

/// The words of a line, separated by blanks or commas.
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const auto from = text.find_first_not_of(" \t\r,", at);
    if (from == std::string_view::npos) break;
    const auto to = std::min(text.find_first_of(" \t\r,", from), text.size());
    words.push_back(text.substr(from, to - from));
    at = to;
  }
  return words;
}

double number_of(const Line& line, std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    fail(line, quoted(word) + " is not a number");
  }
  return value;
}

/// Seconds as written to nanoseconds, exactly: a double has no room for them.
std::int64_t nanoseconds_of(const Line& line, std::string_view word) {
  const auto point = std::min(word.find('.'), word.size());
  std::string digits(word.substr(0, point));
  std::string fraction(word.substr(std::min(point + 1, word.size())));
  if (digits.find_first_of("eE") != std::string::npos || fraction.find_first_of("eE") != std::string::npos) {
    return std::llround(number_of(line, word) * 1e9);
  }
  fraction.resize(9, '0');
  digits += fraction;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(line, quoted(word) + " is not a time in seconds");
  }
  return value;
}

std::int64_t whole_number_of(const Line& line, std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(line, quoted(word) + " is not a time in whole nanoseconds");
  }
  return value;
}

SE3 pose_of(const Line& line, const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
  if (std::abs(rotation.norm() - 1) > 0.01) fail(line, "the quaternion's length must be 1");
  SE3 pose = SE3::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

SE3 kitti_pose(const Line& line, const std::vector<double>& v) {
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 0.01)
    fail(line, "the first 3 x 3 numbers must be a rotation");
  return pose_of(line, {v[3], v[7], v[11]}, Eigen::Quaterniond(R));
}

Kind kind_of(const Line& line, std::size_t num_words) {
  if (num_words == 12) return Kind::kitti;
  if (line.text.find(',') != std::string::npos && num_words >= 8) return Kind::euroc;
  if (num_words == 8) return Kind::tum;
  fail(line, "has " + std::to_string(num_words) +
                 " numbers; allowed are 8 (TUM), 8 or more with commas (EuRoC csv), 12 (KITTI)");
}

TimedPose parse(const Line& line, Kind kind, std::int64_t number) {
  const auto words = words_of(line.text);
  const std::size_t needed = kind == Kind::kitti ? 12 : 8;
  if (words.size() < needed)
    fail(line, "has " + std::to_string(words.size()) + " of " + std::to_string(needed) + " numbers");
  std::vector<double> v;
  for (std::size_t i = 0; i < needed; ++i) v.push_back(number_of(line, words[i]));
  const Eigen::Vector3d translation(v[1], v[2], v[3]);
  switch (kind) {
    case Kind::tum:
      return {nanoseconds_of(line, words[0]), pose_of(line, translation, {v[7], v[4], v[5], v[6]})};
    case Kind::euroc:
      return {whole_number_of(line, words[0]), pose_of(line, translation, {v[4], v[5], v[6], v[7]})};
    case Kind::kitti:
      break;
  }
  return {number, kitti_pose(line, v)};
}

/// times.txt of a KITTI sequence: beside the poses, or in sequences/NN/ beside the folder of NN.txt.
std::optional<std::filesystem::path> times_of(const std::filesystem::path& poses) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(poses).parent_path();
  for (const fs::path& file : {folder / "times.txt", folder / poses.stem() / "times.txt",
                               folder.parent_path() / "sequences" / poses.stem() / "times.txt"}) {
    if (fs::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

/// Seconds, one a line, rising.
std::vector<std::int64_t> read_times(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::int64_t> times;
  Line line{file, 0, {}};
  while (std::getline(stream, line.text)) {
    ++line.number;
    if (is_comment(line.text)) continue;
    const std::int64_t time_ns = nanoseconds_of(line, words_of(line.text).front());
    if (!times.empty() && time_ns <= times.back()) fail(line, "times must increase");
    times.push_back(time_ns);
  }
  return times;
}

}  // namespace

Trajectory read_true_trajectory(const std::filesystem::path& file) {
  Trajectory trajectory = read_trajectory(file);
  const auto times_file = trajectory.timed ? std::nullopt : times_of(file);
  if (!times_file) return trajectory;
  const std::vector<std::int64_t> times = read_times(*times_file);
  if (times.size() != trajectory.poses.size()) {
    throw std::runtime_error(times_file->string() + ": has " + std::to_string(times.size()) + " times, but " +
                             file.string() + " " + std::to_string(trajectory.poses.size()) +
                             " poses; one line for each is needed");
  }
  for (std::size_t i = 0; i < times.size(); ++i) trajectory.poses[i].timestamp_ns = times[i];
  trajectory.timed = true;
  return trajectory;
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be opened");
  Trajectory trajectory;
  std::optional<Kind> kind;
  Line line{file, 0, {}};
  while (std::getline(stream, line.text)) {
    ++line.number;
    if (is_comment(line.text)) continue;
    if (!kind) kind = kind_of(line, words_of(line.text).size());
    const TimedPose pose = parse(line, *kind, static_cast<std::int64_t>(trajectory.poses.size()));
    if (!trajectory.poses.empty() && pose.timestamp_ns <= trajectory.poses.back().timestamp_ns) {
      fail(line, "times must increase");
    }
    trajectory.poses.push_back(pose);
  }
  if (!kind) throw std::runtime_error(file.string() + ": holds no pose");
  trajectory.timed = *kind != Kind::kitti;
  return trajectory;
}

}  // namespace flogmap
