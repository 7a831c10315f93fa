#include "mapping/stereo/block_matcher.hpp"

#include <algorithm>
#include <vector>

#include "mapping/stereo/border_correction.hpp"
#include "mapping/stereo/census.hpp"
#include "mapping/stereo/median.hpp"
#include "mapping/stereo/parallel.hpp"
#include "mapping/stereo/winners.hpp"

namespace flogmap {
namespace {

constexpr int kBoxStep =
    2;                     // a box is 3 x 3 window costs this far apart: 7 x 7 pixels, heavier in the middle
constexpr int kReach = 3;  // h: the four other boxes stand at (+-h, +-h)
constexpr int kLeastLead = 1;
constexpr int kMaxLeftRightPx = 2;
constexpr int kRowsPerBand = 60;

/// The last few rows of an endless volume.
class RowRing {
 public:
  explicit RowRing(int capacity) : capacity_(capacity) {}

  void start(int row, std::size_t row_bytes) {
    next_ = row;
    row_bytes_ = row_bytes;
    bytes_.resize(row_bytes * capacity_);
  }
  [[nodiscard]] int next() const { return next_; }
  std::uint8_t* push() { return row(next_++); }
  [[nodiscard]] std::uint8_t* row(int y) {
    return bytes_.data() + static_cast<std::size_t>(y % capacity_) * row_bytes_;
  }

 private:
  int capacity_;
  int next_ = 0;
  std::size_t row_bytes_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// What one thread needs: every stage keeps only the rows that the next one still looks at.
struct Workspace {
  RowRing hamming{3};
  RowRing sums{2 * kBoxStep + 1};
  RowRing boxes{2 * kReach + 1};
  std::vector<std::uint8_t> window, corners, none;
};

class BlockMatcher : public DisparityMatcher {
 public:
  BlockMatcher(const StereoOptions& options, const MatchKernels& kernels)
      : rule_{.min_disparity = options.min_disparity,
              .num_disparities = options.num_disparities,
              .max_left_right_px = kMaxLeftRightPx,
              .least_lead = kLeastLead},
        num_threads_(threads_to_use(options.num_threads)),
        kernels_(kernels),
        padding_(kernels.stride, 0),
        workspaces_(num_threads_) {
    std::fill(padding_.begin() + rule_.num_disparities, padding_.end(), std::uint8_t{0xFF});
  }

  DisparityImage match(const RectifiedFrame& pair) override {
    DisparityImage disparity{Image<float>(pair.left.width, pair.left.height)};
    if (disparity.px.empty()) return disparity;
    census_.compute(pair, rule_.min_disparity, kernels_, num_threads_);
    const int height = pair.left.height, num_bands = (height + kRowsPerBand - 1) / kRowsPerBand;
    parallel_for(num_threads_, num_bands, [&](int worker, int i) {
      match_rows(height * i / num_bands, height * (i + 1) / num_bands, workspaces_[worker], disparity.px);
    });
    median_3x3(disparity, num_threads_);
    correct_borders(disparity, pair);
    return disparity;
  }

 private:
  void match_rows(int begin, int end, Workspace& work, Image<float>& disparity) const {
    const int width = disparity.width, last = disparity.height - 1;
    start(begin, width, work);
    WinnersBuffer winners(width, kernels_.stride, true);
    for (int y = begin; y < end; ++y) {
      advance_boxes(std::min(y + kReach, last), width, last, work);
      kernels_.two_best_corners(work.boxes.row(std::max(y - kReach, 0)),
                                work.boxes.row(std::min(y + kReach, last)), width, kReach,
                                work.corners.data());
      kernels_.winners_row(work.boxes.row(y), work.corners.data(), work.none.data(), width, padding_.data(),
                           winners.row());
      row_disparities(winners.row(), width, rule_, disparity.row(y));
    }
  }

  void start(int begin, int width, Workspace& work) const {
    const std::size_t row_bytes = static_cast<std::size_t>(width) * kernels_.stride;
    const int first_box = std::max(0, begin - kReach), first_sum = std::max(0, first_box - kBoxStep);
    work.boxes.start(first_box, row_bytes);
    work.sums.start(first_sum, row_bytes);
    work.hamming.start(std::max(0, first_sum - 1), row_bytes);
    work.window.resize(row_bytes);
    work.corners.resize(row_bytes);
    work.none.assign(row_bytes, 0);
  }

  void advance_hamming(int to, int width, Workspace& work) const {
    while (work.hamming.next() <= to) {
      const int y = work.hamming.next();
      kernels_.hamming_row(census_.left(y), census_.right(y), width, work.hamming.push());
    }
  }

  void advance_sums(int to, int width, int last, Workspace& work) const {
    const int row_bytes = width * kernels_.stride;
    while (work.sums.next() <= to) {
      const int y = work.sums.next();
      advance_hamming(std::min(y + 1, last), width, work);
      kernels_.window_cost(work.hamming.row(std::max(y - 1, 0)), work.hamming.row(y),
                           work.hamming.row(std::min(y + 1, last)), row_bytes, work.window.data());
      kernels_.sum_along(work.window.data(), width, kBoxStep, work.sums.push());
    }
  }

  void advance_boxes(int to, int width, int last, Workspace& work) const {
    const int row_bytes = width * kernels_.stride;
    while (work.boxes.next() <= to) {
      const int y = work.boxes.next();
      advance_sums(std::min(y + kBoxStep, last), width, last, work);
      kernels_.box_cost(work.sums.row(std::max(y - kBoxStep, 0)), work.sums.row(y),
                        work.sums.row(std::min(y + kBoxStep, last)), row_bytes, work.boxes.push());
    }
  }

  WinnersRule rule_;
  int num_threads_;
  MatchKernels kernels_;
  std::vector<std::uint8_t> padding_;
  CensusPair census_;
  std::vector<Workspace> workspaces_;
};

}  // namespace

std::unique_ptr<DisparityMatcher> make_block_matcher(const StereoOptions& options,
                                                     const MatchKernels& kernels) {
  return std::make_unique<BlockMatcher>(options, kernels);
}

}  // namespace flogmap
