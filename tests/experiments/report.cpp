#include "tests/experiments/report.hpp"

#include <cstdio>

namespace flogmap::experiments {
namespace {

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string table(const Table& table) {
  std::string lines = row(table.head);
  lines += "|";
  for (std::size_t i = 0; i < table.head.size(); ++i) lines += "---|";
  lines += "\n";
  for (const auto& cells : table.rows) lines += row(cells);
  return lines + "\n";
}

/// Breaks at spaces so that no line is longer than 118 characters.
std::string wrapped(const std::string& paragraph) {
  std::string lines;
  std::size_t width = 0;
  for (std::size_t at = 0; at < paragraph.size();) {
    const std::size_t end = std::min(paragraph.find(' ', at), paragraph.size());
    const std::string word = paragraph.substr(at, end - at);
    if (width > 0 && width + 1 + word.size() > 118) lines += "\n", width = 0;
    if (width > 0) lines += " ", ++width;
    lines += word;
    width += word.size();
    at = end + 1;
  }
  return lines + "\n\n";
}

}  // namespace

std::string markdown(const Report& report) {
  std::string page = "## " + report.title + "\n" + wrapped(report.question);
  for (const Table& one : report.tables) page += table(one);
  for (const Figure& figure : report.figures) page += "![" + figure.caption + "](" + figure.file + ")\n\n";
  return page + wrapped(report.findings);
}

std::string text(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

std::string percent(double share, int decimals) { return text(100 * share, decimals) + " %"; }

}  // namespace flogmap::experiments
