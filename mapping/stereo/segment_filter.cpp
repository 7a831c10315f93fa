#include "mapping/stereo/segment_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace flogmap {
namespace {

/// Neighbours in a row that belong together; pixels [begin, end) of row y.
struct Run {
  int y, begin, end;
};

/// Disjoint sets of runs; the root of a set is its oldest member and knows how many pixels the set has.
class Patches {
 public:
  int add(const Run& run) {
    runs_.push_back(run);
    num_px_.push_back(run.end - run.begin);
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }

  int root(int run) {
    while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
    return run;
  }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    num_px_[a] += num_px_[b];
  }

  int num_px(int run) { return num_px_[root(run)]; }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }

 private:
  std::vector<Run> runs_;
  std::vector<int> num_px_;
  std::vector<int> parent_;
};

/// Splits a row into runs; `run_of` gets the run of every valid pixel.
void find_runs(const float* d, int width, int y, float max_step_px, Patches& patches, int* run_of) {
  for (int x = 0; x < width;) {
    if (std::isnan(d[x])) {
      ++x;
      continue;
    }
    int end = x + 1;
    while (end < width && std::abs(d[end] - d[end - 1]) <= max_step_px) ++end;  // false for NaN
    std::fill(run_of + x, run_of + end, patches.add({y, x, end}));
    x = end;
  }
}

/// Joins the runs of a row with those of the row above.
void join_rows(const float* above, const int* run_above, const float* d, const int* run_of, int width,
               float max_step_px, Patches& patches) {
  int last_above = -1, last = -1;
  for (int x = 0; x < width; ++x) {
    if (!(std::abs(d[x] - above[x]) <= max_step_px)) continue;
    if (run_above[x] == last_above && run_of[x] == last) continue;
    patches.join(last_above = run_above[x], last = run_of[x]);
  }
}

}  // namespace

void remove_small_segments(DisparityImage& disparity, int min_segment_px, float max_step_px) {
  Image<float>& px = disparity.px;
  Patches patches;
  std::vector<int> run_above(px.width), run_of(px.width);
  for (int y = 0; y < px.height; ++y) {
    find_runs(px.row(y), px.width, y, max_step_px, patches, run_of.data());
    if (y > 0) {
      join_rows(px.row(y - 1), run_above.data(), px.row(y), run_of.data(), px.width, max_step_px, patches);
    }
    std::swap(run_above, run_of);
  }
  for (int i = 0; const Run& run : patches.runs()) {
    if (patches.num_px(i++) >= min_segment_px) continue;
    std::fill(px.row(run.y) + run.begin, px.row(run.y) + run.end, std::numeric_limits<float>::quiet_NaN());
  }
}

}  // namespace flogmap
