#include "camera/board_calibration/marker_layout.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace flogmap {
namespace {

using Square = std::array<Eigen::Vector2d, 4>;

Square square_at(double x, double y, double side, bool y_is_up) {
  const double top = y_is_up ? y + side : y, bottom = y_is_up ? y : y + side;
  return {Eigen::Vector2d(x, top), Eigen::Vector2d(x + side, top), Eigen::Vector2d(x + side, bottom),
          Eigen::Vector2d(x, bottom)};
}

MarkerLayout charuco_layout(const BoardSpec& spec, bool white_first) {
  MarkerLayout layout;
  const double side = spec.square_m * spec.marker_share, margin = (spec.square_m - side) / 2;
  // Inner corner 0 is the origin, so the first square lies at negative coordinates.
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      const bool white = (row + column) % 2 == (white_first ? 0 : 1);
      if (!white) continue;
      layout.corners_m.push_back(
          square_at((column - 1) * spec.square_m + margin, (row - 1) * spec.square_m + margin, side, false));
    }
  }
  return layout;
}

MarkerLayout tag_layout(const BoardSpec& spec, bool rows_go_up, std::size_t quarter_turns) {
  MarkerLayout layout;
  const double pitch = spec.square_m * (1 + spec.tag_gap_share);
  for (int id = 0; id < spec.columns * spec.rows; ++id) {
    const int column = id % spec.columns;
    const int row = rows_go_up ? id / spec.columns : spec.rows - 1 - id / spec.columns;
    const Square upright = square_at(column * pitch, row * pitch, spec.square_m, true);
    Square turned;
    for (std::size_t k = 0; k < 4; ++k) turned[k] = upright[(k + quarter_turns) % 4];
    layout.corners_m.push_back(turned);
  }
  return layout;
}

Eigen::Vector2d centre_px(const Marker& marker) { return (marker.corners_px[0] + marker.corners_px[2]) / 2; }

/// A marker and the few nearest to it in the picture: so little of it that no lens bends it much.
std::vector<Marker> neighbourhood(const Marker& middle, std::vector<Marker> markers) {
  constexpr std::size_t kMembers = 5;
  std::sort(markers.begin(), markers.end(), [&](const Marker& a, const Marker& b) {
    return (centre_px(a) - centre_px(middle)).norm() < (centre_px(b) - centre_px(middle)).norm();
  });
  if (markers.size() > kMembers) markers.resize(kMembers);
  return markers;
}

std::optional<double> local_misfit(const MarkerLayout& layout, const std::vector<Marker>& markers) {
  std::vector<cv::Point2f> board, picture;
  double side_m = 0;
  for (const Marker& marker : markers) {
    const auto& corners = layout.corners_m[static_cast<std::size_t>(marker.id)];
    side_m = (corners[1] - corners[0]).norm();
    for (std::size_t k = 0; k < 4; ++k) {
      board.emplace_back(static_cast<float>(corners[k].x()), static_cast<float>(corners[k].y()));
      picture.emplace_back(static_cast<float>(marker.corners_px[k].x()),
                           static_cast<float>(marker.corners_px[k].y()));
    }
  }
  const cv::Mat board_from_picture = cv::findHomography(picture, board, 0);
  if (board_from_picture.empty()) return std::nullopt;
  std::vector<cv::Point2f> mapped;
  cv::perspectiveTransform(picture, mapped, board_from_picture);
  double sum = 0;
  for (std::size_t i = 0; i < board.size(); ++i) sum += std::pow(cv::norm(mapped[i] - board[i]), 2);
  return std::sqrt(sum / static_cast<double>(board.size())) / side_m;
}

}  // namespace

std::vector<MarkerLayout> possible_layouts(const BoardSpec& spec) {
  if (spec.pattern == BoardPattern::charuco) {
    if (spec.rows % 2 == 1) return {charuco_layout(spec, false)};
    return {charuco_layout(spec, false), charuco_layout(spec, true)};
  }
  std::vector<MarkerLayout> layouts;
  for (const bool rows_go_up : {true, false}) {
    for (std::size_t turns = 0; turns < 4; ++turns) layouts.push_back(tag_layout(spec, rows_go_up, turns));
  }
  return layouts;
}

std::optional<double> misfit(const MarkerLayout& layout, const std::vector<Marker>& markers) {
  std::vector<double> misfits;
  for (const Marker& marker : markers) {
    if (const auto local = local_misfit(layout, neighbourhood(marker, markers))) misfits.push_back(*local);
  }
  if (misfits.empty()) return std::nullopt;
  // Two ways of printing may differ at the ends of rows only.
  const auto upper_quartile = misfits.begin() + std::ssize(misfits) * 3 / 4;
  std::nth_element(misfits.begin(), upper_quartile, misfits.end());
  return *upper_quartile;
}

}  // namespace flogmap
