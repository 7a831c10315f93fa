#include "mapping/stereo/sgm_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "mapping/stereo/border_correction.hpp"
#include "mapping/stereo/census.hpp"
#include "mapping/stereo/close_holes.hpp"
#include "mapping/stereo/median.hpp"
#include "mapping/stereo/parallel.hpp"
#include "mapping/stereo/subpixel.hpp"
#include "mapping/stereo/winners.hpp"

namespace flogmap {
namespace {

// Penalties in units of the window cost, 0 to 27: how many more differing comparisons a step is worth.
constexpr int kSmallStep = 12;     // P1: slanted surfaces
constexpr int kJump = 90;          // P2: depth edges, where the picture is smooth
constexpr int kLeastJump = 12;     // P2 across the strongest edge of the picture
constexpr double kJumpEdge = 0.1;  // P2 = kJump / (1 + kJumpEdge * step of brightness)
constexpr int kMaxLeftRightPx = 4;
constexpr int kMaxCost = 80;           // of the half sum of four paths: on average more than 40 per path
constexpr int kWarmUpRows = 16;        // paths start this far outside a band
constexpr int kLargestBandPair = 160;  // rows

/// Rows that are matched independently. They depend on the height alone, never on the number of threads.
struct Band {
  int begin, end;            // rows answered
  int warm_begin, warm_end;  // rows looked at
};

std::vector<Band> bands_of(int height) {
  const int pairs = (height + kLargestBandPair - 1) / kLargestBandPair;
  const int count = height < 4 * kWarmUpRows ? 1 : 2 * pairs;
  std::vector<Band> bands;
  for (int i = 0; i < count; ++i) {
    const int begin = height * i / count, end = height * (i + 1) / count;
    bands.push_back({begin, end, std::max(0, begin - kWarmUpRows), std::min(height, end + kWarmUpRows)});
  }
  return bands;
}

std::array<std::uint8_t, 256> jump_by_brightness_step() {
  std::array<std::uint8_t, 256> jump{};
  for (int step = 0; step < 256; ++step) {
    jump[step] =
        static_cast<std::uint8_t>(std::max(kLeastJump, static_cast<int>(kJump / (1 + kJumpEdge * step))));
  }
  return jump;
}

/// What one thread needs to match a band.
struct Workspace {
  std::vector<std::uint8_t> hamming;   // the last three volume rows of Hamming sums
  std::vector<std::uint8_t> costs;     // volume of the band with its warm-up rows
  std::vector<std::uint8_t> upward;    // volume of the band: costs of the paths that come from below
  std::vector<std::uint8_t> vertical;  // volume row: of the paths of the row before
  std::vector<std::uint8_t> vertical_min;
  std::vector<std::uint8_t> along;  // volume row: of the paths along the row
  std::vector<std::uint8_t> jumps;
};

class SgmMatcher : public DisparityMatcher {
 public:
  SgmMatcher(const StereoOptions& options, const MatchKernels& kernels)
      : rule_{.min_disparity = options.min_disparity,
              .num_disparities = options.num_disparities,
              .max_left_right_px = kMaxLeftRightPx,
              .max_cost = kMaxCost},
        num_threads_(threads_to_use(options.num_threads)),
        kernels_(kernels),
        jump_(jump_by_brightness_step()),
        padding_(kernels.stride, 0),
        subpixel_(static_cast<float>(options.min_disparity), num_threads_),
        workspaces_(num_threads_) {
    std::fill(padding_.begin() + rule_.num_disparities, padding_.end(), std::uint8_t{0xFF});
  }

  DisparityImage match(const RectifiedFrame& pair) override {
    DisparityImage disparity{Image<float>(pair.left.width, pair.left.height)};
    if (disparity.px.empty()) return disparity;
    census_.compute(pair, rule_.min_disparity, kernels_, num_threads_);
    const std::vector<Band> bands = bands_of(pair.left.height);
    parallel_for(num_threads_, static_cast<int>(bands.size()), [&](int worker, int i) {
      match_band(pair.left, bands[i], workspaces_[worker], disparity.px);
    });
    median_3x3(disparity, num_threads_);
    correct_borders(disparity, pair);
    subpixel_.refine(disparity, pair);
    close_holes(disparity);
    return disparity;
  }

 private:
  void match_band(const Image<std::uint8_t>& left, const Band& band, Workspace& work,
                  Image<float>& disparity) {
    compute_costs(left, band, work);
    paths_from_below(left, band, work);
    start_paths(left.width, work);
    WinnersBuffer winners(left.width, kernels_.stride, false);
    work.along.resize(work.vertical.size());
    for (int y = band.warm_begin; y < band.end; ++y) {
      const PathRow path{work.vertical.data(), work.vertical_min.data()};
      advance(left, band, y, y - 1, work, path, path);
      if (y < band.begin) continue;
      const std::size_t row = static_cast<std::size_t>(y - band.begin) * work.vertical.size();
      run_along(left, band, y, work);
      kernels_.winners_row(work.along.data(), work.vertical.data(), work.upward.data() + row, left.width,
                           padding_.data(), winners.row());
      row_disparities(winners.row(), left.width, rule_, disparity.row(y));
    }
  }

  void paths_from_below(const Image<std::uint8_t>& left, const Band& band, Workspace& work) const {
    start_paths(left.width, work);
    work.upward.resize(work.vertical.size() * (band.end - band.begin));
    PathRow before{work.vertical.data(), work.vertical_min.data()};
    for (int y = band.warm_end - 1; y >= band.begin; --y) {
      PathRow here = before;
      if (y < band.end) here.costs = work.upward.data() + (y - band.begin) * work.vertical.size();
      advance(left, band, y, y + 1, work, before, here);
      before = here;
    }
  }

  /// Costs of all rows of a band: Hamming distances, summed over 3 x 3 pixels.
  void compute_costs(const Image<std::uint8_t>& left, const Band& band, Workspace& work) const {
    const std::size_t row_bytes = static_cast<std::size_t>(left.width) * kernels_.stride;
    work.hamming.resize(3 * row_bytes);
    work.costs.resize(row_bytes * (band.warm_end - band.warm_begin));
    const auto hamming = [&](int y) { return work.hamming.data() + (y + 3) % 3 * row_bytes; };
    const auto add_row = [&](int y) {
      const int source = std::clamp(y, 0, left.height - 1);
      kernels_.hamming_row(census_.left(source), census_.right(source), left.width, hamming(y));
    };
    add_row(band.warm_begin - 1);
    add_row(band.warm_begin);
    for (int y = band.warm_begin; y < band.warm_end; ++y) {
      add_row(y + 1);
      kernels_.window_cost(hamming(y - 1), hamming(y), hamming(y + 1), static_cast<int>(row_bytes),
                           work.costs.data() + (y - band.warm_begin) * row_bytes);
    }
  }

  void start_paths(int width, Workspace& work) const {
    work.vertical.assign(static_cast<std::size_t>(width) * kernels_.stride, 0);
    work.vertical_min.assign(width, 0);
    work.jumps.assign(width + 1, kLeastJump);
  }

  [[nodiscard]] const std::uint8_t* costs_of(const Band& band, int y, const Workspace& work) const {
    return work.costs.data() + static_cast<std::size_t>(y - band.warm_begin) * work.vertical.size();
  }

  /// Vertical paths, from row `y_before` into row y.
  void advance(const Image<std::uint8_t>& left, const Band& band, int y, int y_before, Workspace& work,
               const PathRow& before, const PathRow& here) const {
    const std::uint8_t* a = left.row(y);
    const std::uint8_t* b = left.row(std::clamp(y_before, 0, left.height - 1));
    for (int x = 0; x < left.width; ++x) work.jumps[x] = jump_[std::abs(a[x] - b[x])];
    kernels_.path_down(costs_of(band, y, work), left.width, padding_.data(), {kSmallStep, work.jumps.data()},
                       before, here);
  }

  /// Paths along row y, both ways.
  void run_along(const Image<std::uint8_t>& left, const Band& band, int y, Workspace& work) const {
    const std::uint8_t* a = left.row(y);
    for (int x = 1; x < left.width; ++x) work.jumps[x] = jump_[std::abs(a[x] - a[x - 1])];
    kernels_.paths_along(costs_of(band, y, work), left.width, padding_.data(),
                         {kSmallStep, work.jumps.data()}, work.along.data());
  }

  WinnersRule rule_;
  int num_threads_;
  MatchKernels kernels_;
  std::array<std::uint8_t, 256> jump_;
  std::vector<std::uint8_t> padding_;
  CensusPair census_;
  SubpixelFit subpixel_;
  std::vector<Workspace> workspaces_;
};

}  // namespace

std::unique_ptr<DisparityMatcher> make_sgm_matcher(const StereoOptions& options,
                                                   const MatchKernels& kernels) {
  return std::make_unique<SgmMatcher>(options, kernels);
}

}  // namespace flogmap
