// The paper's first experiment and what can be varied in it.
#pragma once

#include <array>

#include "camera/simulation/scene.hpp"
#include "mapping/flog/flog_options.hpp"
#include "tests/experiments/passage.hpp"
#include "tests/experiments/side_width.hpp"

namespace flogmap::experiments {

inline constexpr double kTwoBoxesRange_m = 2.5;  // the boxes, and not the room around them

/// 10 mm cells and one layer from the floor to the boxes' tops, as in the paper.
[[nodiscard]] FlogOptions two_boxes_options();

/// Every step of the circle becomes a view.
[[nodiscard]] PassageOptions two_boxes_passage_options();

/// Circled once in 32 steps at this distance from the boxes' middle.
[[nodiscard]] Scene two_boxes_from(double distance_m);

/// The camera stands at the first place for so many frames before it circles, and its sensor is noisy.
[[nodiscard]] Scene two_boxes_after_standing(int num_frames);

/// Sides of the left box that nothing hides.
[[nodiscard]] std::array<Side, 3> open_sides();
/// Its side that faces the other box, a hand's breadth away.
[[nodiscard]] Side hidden_side();

/// Mean width of the open sides in a map of the views at their true poses.
[[nodiscard]] double mean_side_width_m(const Passage& passage, double cell_size_m);

}  // namespace flogmap::experiments
