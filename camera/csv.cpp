#include "camera/csv.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace flogmap {
namespace {

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const auto from = text.find_first_not_of(kBlanks);
  if (from == std::string_view::npos) return {};
  return std::string(text.substr(from, text.find_last_not_of(kBlanks) - from + 1));
}

template <typename T>
bool parse_whole(std::string_view field, T& value) {
  const char* end = field.data() + field.size();
  const auto [stopped, error] = std::from_chars(field.data(), end, value);
  return error == std::errc() && stopped == end && !field.empty();
}

}  // namespace

std::vector<CsvRow> read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ": cannot be opened");
  std::vector<CsvRow> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    CsvRow row{number, {}};
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t comma = std::min(text.find(',', from), text.size());
      row.fields.push_back(trimmed(std::string_view(text).substr(from, comma - from)));
      from = comma + 1;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

bool parse_number(std::string_view field, double& value) {
  return parse_whole(field, value) && std::isfinite(value);
}

bool parse_number(std::string_view field, std::int64_t& value) { return parse_whole(field, value); }

}  // namespace flogmap
