// Line charts as SVG: small, sharp, and readable as text.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace flogmap::experiments {

struct Series {
  std::string name;
  std::vector<Eigen::Vector2d> points;
};

struct LineChart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
  bool from_zero = true;  // the y axis
};

/// Throws std::runtime_error naming the file if it cannot be written.
void write_chart(const std::filesystem::path& file, const LineChart& chart);

}  // namespace flogmap::experiments
