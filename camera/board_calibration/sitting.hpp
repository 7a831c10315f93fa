#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "camera/board_calibration/board_detector.hpp"
#include "camera/board_calibration/picture_areas.hpp"
#include "camera/board_calibration/stereo_calibrator.hpp"

namespace flogmap {

/// How a sitting stands after a pair of pictures.
struct SittingState {
  int width_px = 0, height_px = 0;
  std::int64_t num_frames = 0;
  BoardView left, right;                   // in the newest pair
  bool kept = false;                       // the newest pair was worth it
  std::size_t num_pairs = 0;               // kept so far
  AreaCounts left_areas{}, right_areas{};  // kept corners
  std::array<bool, 4> tilted{};  // its left, right, upper, lower side in the picture was the nearer one
  std::string advice;            // what to do now, in words
  bool enough = false;           // nothing is missing
};

/// Somebody holds a board before two cameras: keeps the pairs in which it is at rest and shows something new,
/// and says what is still missing. Knows neither clocks nor threads.
class CalibrationSitting {
 public:
  static constexpr std::size_t kEnoughPairs = 15;
  static constexpr std::size_t kMostPairs = 60;

  /// `photos`: every pair is one by itself, not part of a video in which a board at rest can be told from a
  /// moving one. Throws std::runtime_error if the board cannot be.
  explicit CalibrationSitting(const BoardSpec& spec, bool photos = false);

  /// Takes a look at a pair of one size with all before; of another size, it begins anew.
  void look_at(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right);
  /// Forgets every pair.
  void restart();

  [[nodiscard]] const SittingState& state() const { return state_; }
  [[nodiscard]] const std::vector<BoardPair>& pairs() const { return pairs_; }
  [[nodiscard]] std::vector<std::string> names() const;  // "pair 1", ...

 private:
  [[nodiscard]] bool is_at_rest() const;
  [[nodiscard]] bool is_new() const;
  void keep();
  [[nodiscard]] std::string advise(const std::string& problem) const;
  [[nodiscard]] std::string what_is_missing() const;

  BoardSpec spec_;
  bool photos_;
  std::vector<Eigen::Vector3d> board_;
  BoardDetector detector_;
  std::vector<BoardPair> pairs_;
  BoardView before_;  // what the left camera saw in the pair before
  SittingState state_;
};

/// How much nearer a board is at one edge than in its middle, by its perspective: x > 0 if its right side in
/// the picture is nearer, y > 0 if its lower side is; a side 1/10 nearer gives 0.1. Zero if too few points
/// are seen.
[[nodiscard]] Eigen::Vector2d nearer_side(const BoardView& view, const std::vector<Eigen::Vector3d>& board);

}  // namespace flogmap
