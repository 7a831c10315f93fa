#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flogmap {

/// One line of a comma-separated file.
struct CsvRow {
  int line = 0;  // from 1
  std::vector<std::string> fields;
};

/// Rows of a comma-separated file without comments (#) and empty lines; blanks around fields and CR are
/// dropped. Throws std::runtime_error if the file cannot be opened.
[[nodiscard]] std::vector<CsvRow> read_csv(const std::filesystem::path& file);

/// A whole field as a number; false if it is anything else or not finite.
[[nodiscard]] bool parse_number(std::string_view field, double& value);
[[nodiscard]] bool parse_number(std::string_view field, std::int64_t& value);

}  // namespace flogmap
