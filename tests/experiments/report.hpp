// What an experiment hands back, and how it is written down.
#pragma once

#include <string>
#include <vector>

namespace flogmap::experiments {

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct Figure {
  std::string file;  // beside the report
  std::string caption;
};

struct Report {
  std::string title;
  std::string question;  // what is measured and what the paper says of it
  std::vector<Table> tables;
  std::vector<Figure> figures;
  std::string findings;  // two sentences, the second on where the method is worse
};

/// As a section of a Markdown page.
[[nodiscard]] std::string markdown(const Report& report);

/// A number with so many decimals.
[[nodiscard]] std::string text(double value, int decimals);
[[nodiscard]] std::string percent(double share, int decimals = 1);

}  // namespace flogmap::experiments
