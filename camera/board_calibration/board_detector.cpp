#include "camera/board_calibration/board_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "camera/board_calibration/marker_layout.hpp"

namespace flogmap {
namespace {

using Picture8 = Image<std::uint8_t>;
using Points = std::vector<cv::Point2f>;

constexpr const char* kTagFamily = "APRILTAG_36h11";

cv::Mat view_of(const Picture8& picture) {  // OpenCV has no read-only view; the matrix is only read
  return {picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.pixels.data())};
}

/// Moves every point to where the edges around it cross; `reach_px` is half the side of the window.
void refine(const Picture8& picture, Points& points, int reach_px) {
  if (points.empty()) return;
  const cv::TermCriteria enough(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 60, 1e-3);
  cv::cornerSubPix(view_of(picture), points, {reach_px, reach_px}, {-1, -1}, enough);
}

int reach_px(double free_px) { return std::clamp(static_cast<int>(0.7 * free_px), 2, 9); }

// -------------------------------------------------------------------------------------------- chessboard

double smallest_step_px(const Points& corners, int columns) {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((i + 1) % static_cast<std::size_t>(columns) != 0)
      smallest = std::min(smallest, cv::norm(corners[i + 1] - corners[i]));
    if (i + static_cast<std::size_t>(columns) < corners.size())
      smallest = std::min(smallest, cv::norm(corners[i + static_cast<std::size_t>(columns)] - corners[i]));
  }
  return smallest;
}

BoardSighting find_chessboard(const BoardSpec& spec, const Picture8& picture) {
  Points corners;
  const cv::Size size(spec.columns, spec.rows);
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  const bool found =
      cv::findChessboardCorners(view_of(picture), size, corners, flags | cv::CALIB_CB_FAST_CHECK) ||
      cv::findChessboardCornersSB(view_of(picture), size, corners, cv::CALIB_CB_NORMALIZE_IMAGE);
  if (!found)
    return {{},
            "no chessboard of " + std::to_string(spec.columns) + "x" + std::to_string(spec.rows) +
                " inner corners in full view"};
  refine(picture, corners, reach_px(smallest_step_px(corners, spec.columns) / 2));
  BoardSighting sighting;
  for (const cv::Point2f& corner : corners) {
    sighting.view.points.push_back(static_cast<int>(sighting.view.points.size()));
    sighting.view.pixels.emplace_back(corner.x, corner.y);
  }
  return sighting;
}

// ----------------------------------------------------------------------------------------------- markers

double side_px(const Marker& marker) {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < 4; ++k)
    smallest = std::min(smallest, (marker.corners_px[(k + 1) % 4] - marker.corners_px[k]).norm());
  return smallest;
}

/// The one layout that fits, if the others clearly do not.
std::optional<MarkerLayout> fitting_layout(const BoardSpec& spec, const std::vector<Marker>& markers) {
  constexpr double kFits = 0.12, kDoesNot = 0.25;  // sides of a marker; lenses bend lines by some hundredths
  std::optional<MarkerLayout> best;
  int fitting = 0, doubtful = 0;
  for (MarkerLayout& layout : possible_layouts(spec)) {
    const std::optional<double> error = misfit(layout, markers);
    if (!error) return std::nullopt;
    if (*error < kFits)
      best = std::move(layout), ++fitting;
    else if (*error < kDoesNot)
      ++doubtful;
  }
  return fitting == 1 && doubtful == 0 ? best : std::nullopt;
}

/// Moves a marker's corner numbers to the order of board_points(): upper left of the upright tag first.
std::size_t upright_corner(const MarkerLayout& layout, std::size_t id, std::size_t k) {
  const auto& corners = layout.corners_m[id];
  const Eigen::Vector2d centre = (corners[0] + corners[2]) / 2;
  const bool right = corners[k].x() > centre.x(), up = corners[k].y() > centre.y();
  return up ? (right ? 1 : 0) : (right ? 2 : 3);
}

std::size_t upright_tag(const BoardSpec& spec, const MarkerLayout& layout, std::size_t id) {
  const double pitch = spec.square_m * (1 + spec.tag_gap_share);
  const Eigen::Vector2d centre = (layout.corners_m[id][0] + layout.corners_m[id][2]) / 2;
  const auto column = static_cast<std::size_t>(centre.x() / pitch),
             row = static_cast<std::size_t>(centre.y() / pitch);
  return row * static_cast<std::size_t>(spec.columns) + column;
}

BoardSighting tag_view(const BoardSpec& spec, const MarkerLayout& layout, int border_bits,
                       const std::vector<Marker>& markers, const Picture8& picture) {
  constexpr int kTagBits = 6;
  BoardSighting sighting;
  for (const Marker& marker : markers) {
    const double side = side_px(marker);
    Points corners;
    for (const Eigen::Vector2d& corner : marker.corners_px)
      corners.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    const double border_px = side * border_bits / (kTagBits + 2 * border_bits);
    refine(picture, corners, reach_px(std::min(border_px, side * spec.tag_gap_share)));
    const auto id = static_cast<std::size_t>(marker.id);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t point = 4 * upright_tag(spec, layout, id) + upright_corner(layout, id, k);
      sighting.view.points.push_back(static_cast<int>(point));
      sighting.view.pixels.emplace_back(corners[k].x, corners[k].y);
    }
  }
  return sighting;
}

/// Where the markers around a corner of squares say that it is.
std::optional<cv::Point2f> predict_corner(const Eigen::Vector2d& corner_m, double square_m,
                                          const MarkerLayout& layout, const std::vector<Marker>& markers) {
  Points board, picture;
  for (const Marker& marker : markers) {
    const auto& corners = layout.corners_m[static_cast<std::size_t>(marker.id)];
    const Eigen::Vector2d centre = (corners[0] + corners[2]) / 2;
    if ((centre - corner_m).cwiseAbs().maxCoeff() > 0.75 * square_m)
      continue;  // not one of those that touch it
    for (std::size_t k = 0; k < 4; ++k) {
      board.emplace_back(static_cast<float>(corners[k].x()), static_cast<float>(corners[k].y()));
      picture.emplace_back(static_cast<float>(marker.corners_px[k].x()),
                           static_cast<float>(marker.corners_px[k].y()));
    }
  }
  if (board.empty()) return std::nullopt;
  const cv::Mat picture_from_board = cv::findHomography(board, picture, 0);
  if (picture_from_board.empty()) return std::nullopt;
  const Points at{{static_cast<float>(corner_m.x()), static_cast<float>(corner_m.y())}};
  Points predicted;
  cv::perspectiveTransform(at, predicted, picture_from_board);
  return predicted[0];
}

BoardSighting charuco_view(const BoardSpec& spec, const MarkerLayout& layout,
                           const std::vector<Marker>& markers, const Picture8& picture) {
  double smallest_px = std::numeric_limits<double>::max();
  for (const Marker& marker : markers) smallest_px = std::min(smallest_px, side_px(marker));
  const double margin_px = smallest_px * (1 - spec.marker_share) / (2 * spec.marker_share);
  const std::vector<Eigen::Vector3d> points = board_points(spec);
  Points corners;
  BoardSighting sighting;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto corner = predict_corner(points[i].head<2>(), spec.square_m, layout, markers);
    const double rim = 4;  // px; nearer to the border there is no window to refine in
    if (!corner || corner->x < rim || corner->y < rim ||
        corner->x > static_cast<float>(picture.width - 1 - rim) ||
        corner->y > static_cast<float>(picture.height - 1 - rim))
      continue;
    corners.push_back(*corner);
    sighting.view.points.push_back(static_cast<int>(i));
  }
  const Points predicted = corners;
  refine(picture, corners, reach_px(1.4 * margin_px));  // no corner of a marker in the window
  BoardView kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (cv::norm(corners[i] - predicted[i]) > std::max(2.0, margin_px)) continue;  // slid off to another edge
    kept.points.push_back(sighting.view.points[i]);
    kept.pixels.emplace_back(corners[i].x, corners[i].y);
  }
  sighting.view = std::move(kept);
  return sighting;
}

}  // namespace

/// How this board is printed, once a picture has told.
struct BoardDetector::Learned {
  std::string dictionary;
  int border_bits = 0;  // 0: not known yet
  std::optional<MarkerLayout> layout;
};

namespace {

int num_markers(const BoardSpec& spec) {
  return spec.pattern == BoardPattern::apriltag ? spec.columns * spec.rows : spec.columns * spec.rows / 2;
}

/// Markers of this board alone.
std::vector<Marker> find_own_markers(const BoardSpec& spec, const Picture8& picture,
                                     const std::string& dictionary, int border_bits) {
  std::vector<Marker> markers = find_markers(picture, dictionary, border_bits);
  std::erase_if(markers, [&](const Marker& marker) { return marker.id >= num_markers(spec); });
  return markers;
}

}  // namespace

BoardDetector::BoardDetector(const BoardSpec& spec) : spec_(spec), learned_(std::make_unique<Learned>()) {
  check(spec);
  if (spec.pattern == BoardPattern::chessboard) return;
  if (!markers_are_supported()) (void)find_markers(Picture8(16, 16), kTagFamily, 1);  // throws, saying why
  learned_->dictionary = spec.pattern == BoardPattern::apriltag ? kTagFamily : spec.dictionary;
  if (spec.pattern == BoardPattern::charuco) learned_->border_bits = 1;
}

BoardDetector::~BoardDetector() = default;
BoardDetector::BoardDetector(BoardDetector&&) noexcept = default;
BoardDetector& BoardDetector::operator=(BoardDetector&&) noexcept = default;

BoardSighting BoardDetector::find(const Image<std::uint8_t>& picture) {
  if (spec_.pattern == BoardPattern::chessboard) return find_chessboard(spec_, picture);
  std::vector<std::string> dictionaries{learned_->dictionary};
  if (learned_->dictionary.empty()) dictionaries = aruco_dictionaries();
  std::vector<int> borders{learned_->border_bits};
  if (learned_->border_bits == 0) borders = {1, 2};  // Kalibr prints tags with a border of two bits
  std::vector<Marker> markers;
  Learned seen = *learned_;
  for (const std::string& dictionary : dictionaries) {
    for (const int border_bits : borders) {
      std::vector<Marker> found = find_own_markers(spec_, picture, dictionary, border_bits);
      if (found.size() <= markers.size()) continue;
      markers = std::move(found);
      seen.dictionary = dictionary;
      seen.border_bits = border_bits;
    }
  }
  constexpr std::size_t kFewest = 3;
  if (markers.size() < kFewest) return {{}, "fewer than 3 of the board's markers in view"};
  if (!seen.layout) seen.layout = fitting_layout(spec_, markers);
  if (!seen.layout) return {{}, "the markers do not lie as on such a board; check --pattern and --board"};
  *learned_ = seen;
  return spec_.pattern == BoardPattern::apriltag
             ? tag_view(spec_, *seen.layout, seen.border_bits, markers, picture)
             : charuco_view(spec_, *seen.layout, markers, picture);
}

void match_directions(const BoardView& left, BoardView& right) {
  if (left.points.size() < 2 || left.points.size() != right.points.size()) return;
  const Eigen::Vector2d in_left = left.pixels.back() - left.pixels.front();
  const Eigen::Vector2d in_right = right.pixels.back() - right.pixels.front();
  if (in_left.dot(in_right) < 0) std::reverse(right.pixels.begin(), right.pixels.end());
}

}  // namespace flogmap
