#include "camera/board_calibration/sitting.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace flogmap {
namespace {

constexpr double kRestPx = 2;        // a board that moves less from picture to picture is not blurred
constexpr double kNewShare = 0.04;   // of the picture's diagonal: a board elsewhere
constexpr double kTiltShare = 0.05;  // one side nearer by so much
constexpr std::size_t kFewPoints = 12;

/// Root mean square distance of the points that both views show; nothing in common is far.
double distance_px(const BoardView& a, const BoardView& b) {
  std::map<int, Eigen::Vector2d> of_a;
  for (std::size_t i = 0; i < a.points.size(); ++i) of_a.emplace(a.points[i], a.pixels[i]);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < b.points.size(); ++i) {
    const auto found = of_a.find(b.points[i]);
    if (found == of_a.end()) continue;
    sum += (found->second - b.pixels[i]).squaredNorm();
    ++count;
  }
  constexpr double kFarPx = 1e9;
  return count > 0 ? std::sqrt(sum / count) : kFarPx;
}

std::string first_empty(const AreaCounts& areas) {
  const auto empty = std::find(areas.begin(), areas.end(), 0);
  return empty == areas.end() ? std::string() : area_name(static_cast<std::size_t>(empty - areas.begin()));
}

}  // namespace

Eigen::Vector2d nearer_side(const BoardView& view, const std::vector<Eigen::Vector3d>& board) {
  if (view.points.size() < kFewPoints) return Eigen::Vector2d::Zero();
  const Eigen::Vector3d middle = (board.front() + board.back()) / 2;
  const Eigen::Vector3d half = ((board.back() - board.front()) / 2).cwiseAbs();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& pixel : view.pixels) centre += pixel / static_cast<double>(view.pixels.size());
  // Homography from the board (its edges at -1 and 1) to pixels around their centre, by least squares with
  // its last element 1: then the other two of its last row are how depth changes from the middle to the
  // edges.
  Eigen::MatrixXd A(2 * std::ssize(view.points), 8);
  Eigen::VectorXd b(2 * std::ssize(view.points));
  for (Eigen::Index i = 0; i < std::ssize(view.points); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::Vector3d p = board.at(static_cast<std::size_t>(view.points[at])) - middle;
    const double x = p.x() / half.x(), y = p.y() / half.y();
    const Eigen::Vector2d q = view.pixels[at] - centre;
    A.row(2 * i) << x, y, 1, 0, 0, 0, -q.x() * x, -q.x() * y;
    A.row(2 * i + 1) << 0, 0, 0, x, y, 1, -q.y() * x, -q.y() * y;
    b.segment<2>(2 * i) = q;
  }
  const Eigen::VectorXd h = A.colPivHouseholderQr().solve(b);
  const Eigen::Vector2d on_board = -h.tail<2>();
  const Eigen::Vector2d in_picture(h[0] * on_board.x() + h[1] * on_board.y(),
                                   h[3] * on_board.x() + h[4] * on_board.y());
  if (in_picture.isZero()) return in_picture;
  return on_board.norm() * in_picture.normalized();
}

CalibrationSitting::CalibrationSitting(const BoardSpec& spec, bool photos)
    : spec_(spec), photos_(photos), board_(board_points(spec)), detector_(spec) {}

void CalibrationSitting::restart() {
  pairs_.clear();
  const SittingState before = std::move(state_);
  state_ = {};
  state_.width_px = before.width_px;
  state_.height_px = before.height_px;
  state_.num_frames = before.num_frames;
}

void CalibrationSitting::look_at(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right) {
  if (left.width != state_.width_px || left.height != state_.height_px) {
    restart();
    state_.width_px = left.width;
    state_.height_px = left.height;
  }
  ++state_.num_frames;
  before_ = std::move(state_.left);
  BoardSighting in_left = detector_.find(left), in_right = detector_.find(right);
  state_.left = std::move(in_left.view);
  state_.right = std::move(in_right.view);
  if (spec_.pattern == BoardPattern::chessboard && !state_.left.empty() && !state_.right.empty())
    match_directions(state_.left, state_.right);
  state_.kept = !state_.left.empty() && !state_.right.empty() && is_at_rest() && is_new();
  if (state_.kept) keep();
  state_.advice = advise(state_.left.empty() ? in_left.problem : in_right.problem);
}

bool CalibrationSitting::is_at_rest() const { return photos_ || distance_px(before_, state_.left) < kRestPx; }

bool CalibrationSitting::is_new() const {
  if (pairs_.size() >= kMostPairs) return false;
  const double enough_px = photos_ ? kRestPx : kNewShare * std::hypot(state_.width_px, state_.height_px);
  return std::all_of(pairs_.begin(), pairs_.end(),
                     [&](const BoardPair& pair) { return distance_px(pair.left, state_.left) > enough_px; });
}

void CalibrationSitting::keep() {
  for (const Eigen::Vector2d& pixel : state_.left.pixels)
    ++state_.left_areas[area_of(pixel, state_.width_px, state_.height_px)];
  for (const Eigen::Vector2d& pixel : state_.right.pixels)
    ++state_.right_areas[area_of(pixel, state_.width_px, state_.height_px)];
  const Eigen::Vector2d nearer = nearer_side(state_.left, board_);
  const std::array<bool, 4> tilted{nearer.x() < -kTiltShare, nearer.x() > kTiltShare,
                                   nearer.y() < -kTiltShare, nearer.y() > kTiltShare};
  for (std::size_t i = 0; i < tilted.size(); ++i) state_.tilted[i] = state_.tilted[i] || tilted[i];
  pairs_.push_back({state_.left, state_.right});
  state_.num_pairs = pairs_.size();
  state_.enough = what_is_missing().empty();
}

std::string CalibrationSitting::what_is_missing() const {
  for (const auto& [areas, side] : {std::pair(&state_.left_areas, "left"), {&state_.right_areas, "right"}}) {
    const std::string area = first_empty(*areas);
    if (!area.empty()) return std::string("Hold the board to the ") + area + " of the " + side + " picture";
  }
  static constexpr std::array<const char*, 4> kSides{"left", "right", "upper", "lower"};  // as in the picture
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    if (!state_.tilted[i])
      return std::string("Tilt the board: its ") + kSides[i] + " edge 30 degrees towards the cameras";
  }
  if (pairs_.size() < kEnoughPairs) return "Hold the board at other places, nearer and farther";
  return {};
}

std::string CalibrationSitting::advise(const std::string& problem) const {
  if (state_.left.empty() && state_.right.empty())
    return "Show the whole board to both cameras" + (problem.empty() ? "" : ": " + problem);
  if (state_.left.empty()) return "The left camera does not see the whole board: move it to the left";
  if (state_.right.empty()) return "The right camera does not see the whole board: move it to the right";
  const std::string missing = what_is_missing();
  if (missing.empty()) return "That is enough: calibrate, or go on for more";
  if (state_.kept) return "Kept. " + missing;
  return is_new() && !is_at_rest() ? "Hold it still" : missing;
}

std::vector<std::string> CalibrationSitting::names() const {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= pairs_.size(); ++i) names.push_back("pair " + std::to_string(i));
  return names;
}

}  // namespace flogmap
