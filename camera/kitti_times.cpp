#include "camera/kitti_times.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "camera/csv.hpp"

namespace flogmap {
namespace {

constexpr double kNsPerS = 1e9;
constexpr double kLargestS = 4e9;  // in the year 2096

/// "2011-09-26 13:02:25.594360375", the fraction with any number of digits.
std::optional<std::int64_t> parse_day_and_time(const std::string& text) {
  namespace chr = std::chrono;
  int year = 0, hour = 0, minute = 0, length = 0;
  unsigned month = 0, day = 0;
  double seconds = 0;
  if (std::sscanf(text.c_str(), "%4d-%2u-%2u %2d:%2d:%n", &year, &month, &day, &hour, &minute, &length) !=
          5 ||
      length == 0 ||
      !parse_number(std::string_view(text).substr(static_cast<std::size_t>(length)), seconds)) {
    return std::nullopt;
  }
  const chr::year_month_day date{chr::year(year), chr::month(month), chr::day(day)};
  if (!date.ok() || hour > 23 || minute > 59 || seconds < 0 || seconds >= 61) return std::nullopt;
  const auto whole = chr::sys_days(date).time_since_epoch() + chr::hours(hour) + chr::minutes(minute);
  return chr::nanoseconds(whole).count() + std::llround(kNsPerS * seconds);
}

std::optional<std::size_t> number_of(const std::filesystem::path& picture) {
  std::int64_t number = 0;
  if (!parse_number(picture.stem().string(), number) || number < 0) return std::nullopt;
  return static_cast<std::size_t>(number);
}

}  // namespace

std::vector<std::int64_t> read_kitti_times(const std::filesystem::path& file) {
  std::vector<std::int64_t> times;
  if (!std::filesystem::exists(file)) return times;
  for (const CsvRow& row : read_csv(file)) {
    double seconds = 0;
    if (parse_number(row.fields[0], seconds) && std::abs(seconds) < kLargestS) {
      times.push_back(std::llround(kNsPerS * seconds));
    } else if (const auto time_ns = parse_day_and_time(row.fields[0])) {
      times.push_back(*time_ns);
    } else {
      throw std::runtime_error(file.string() + ":" + std::to_string(row.line) +
                               ": must be seconds, or a day and a time of day, got '" + row.fields[0] + "'");
    }
  }
  return times;
}

std::vector<std::size_t> kitti_lines(const std::vector<std::filesystem::path>& pictures,
                                     std::size_t num_lines) {
  std::vector<std::size_t> by_number, in_order;
  for (const std::filesystem::path& picture : pictures) {
    in_order.push_back(in_order.size());
    if (const auto number = number_of(picture)) by_number.push_back(*number);
  }
  const bool known = by_number.size() == pictures.size() && !pictures.empty() &&
                     (by_number.front() == 0 || by_number.back() < num_lines);
  return known ? by_number : in_order;
}

}  // namespace flogmap
