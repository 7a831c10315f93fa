#pragma once

#include <memory>

#include "camera/board_calibration/board.hpp"

namespace flogmap {

/// Finds a board's points in pictures, to a fraction of a pixel. What is printed in more than one way (the
/// order of tags, the first square of a ChArUco board, its dictionary) is learned from the first picture that
/// tells, and holds for all later ones.
class BoardDetector {
 public:
  /// Throws std::runtime_error if the board cannot be, or needs markers that this build cannot find.
  explicit BoardDetector(const BoardSpec& spec);
  ~BoardDetector();
  BoardDetector(BoardDetector&&) noexcept;
  BoardDetector& operator=(BoardDetector&&) noexcept;

  [[nodiscard]] BoardSighting find(const Image<std::uint8_t>& picture);

 private:
  struct Learned;
  BoardSpec spec_;
  std::unique_ptr<Learned> learned_;
};

/// A chessboard looks the same turned by half: numbers the right view's points as the left view's, whose
/// directions they share. Cameras of a pair stand side by side, so the same side is up in both.
void match_directions(const BoardView& left, BoardView& right);

}  // namespace flogmap
