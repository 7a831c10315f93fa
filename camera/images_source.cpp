#include "camera/images_source.hpp"

#include <glob.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "camera/csv.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSmallestTime = 1'000'000'000'000'000;  // 16 digits

struct NumberedFile {
  std::int64_t number;
  fs::path file;
};

/// The last run of digits of a name without its extension.
std::optional<std::int64_t> number_in(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  std::int64_t number = 0;
  return parse_number(stem.substr(first, last - first + 1), number) ? std::optional(number) : std::nullopt;
}

/// Files that match, by their numbers if every file has one of its own, else numbered in order of their
/// names.
std::vector<NumberedFile> matching_files(const std::string& pattern, bool& by_order) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_TILDE, nullptr, &found);
  std::vector<fs::path> files;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  if (files.empty()) throw std::runtime_error("'" + pattern + "' matches no picture");
  std::map<std::int64_t, fs::path> numbered;
  for (const fs::path& file : files) {
    if (const auto number = number_in(file)) numbered.emplace(*number, file);
  }
  std::vector<NumberedFile> result;
  if (numbered.size() == files.size() && !by_order) {
    for (const auto& [number, file] : numbered) result.push_back({number, file});
    return result;
  }
  by_order = true;
  for (std::size_t i = 0; i < files.size(); ++i) result.push_back({static_cast<std::int64_t>(i), files[i]});
  return result;
}

}  // namespace

PicturePairList list_images(const std::string& globs, double rate_hz) {
  const std::size_t comma = globs.find(',');
  if (comma == std::string::npos || globs.find(',', comma + 1) != std::string::npos) {
    throw std::runtime_error("images: must be LEFT_GLOB,RIGHT_GLOB, got '" + globs + "'");
  }
  bool by_order = false;
  std::vector<NumberedFile> left = matching_files(globs.substr(0, comma), by_order);
  const bool left_by_order = by_order;
  const std::vector<NumberedFile> right = matching_files(globs.substr(comma + 1), by_order);
  if (by_order && !left_by_order) left = matching_files(globs.substr(0, comma), by_order);

  PicturePairList list;
  const bool has_times = left.front().number >= kSmallestTime;
  if (!has_times) list.assumed = "the names hold no times; " + assumed_rate(rate_hz);
  if (by_order && left.size() != right.size()) {
    list.assumed += "; they hold no numbers either, and of " + std::to_string(left.size()) + " left and " +
                    std::to_string(right.size()) +
                    " right pictures those at the same place in order are taken as pairs";
  }
  std::size_t l = 0, r = 0;
  while (l < left.size() || r < right.size()) {
    if (r == right.size() || (l < left.size() && left[l].number < right[r].number)) {
      list.skip(left[l++].file.string() + ": no right picture of that number");
    } else if (l == left.size() || right[r].number < left[l].number) {
      list.skip(right[r++].file.string() + ": no left picture of that number");
    } else {
      const std::int64_t time_ns = has_times ? left[l].number : time_at(l, rate_hz);
      list.pairs.push_back({time_ns, left[l++].file, right[r++].file});
    }
  }
  return list;
}

}  // namespace flogmap
