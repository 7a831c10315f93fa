#include "tests/bench/stereo_bench_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

constexpr int kEdgeReachPx = 4;
constexpr double kTexturedSigma = 3;  // grey levels: standard deviation in a 7 x 7 window

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : std::numeric_limits<double>::quiet_NaN();
}

/// 1 where the truth steps by more than a pixel of disparity within reach.
Image<std::uint8_t> near_depth_edge(const Image<float>& truth) {
  Image<std::uint8_t> out(truth.width, truth.height, 0);
  const auto mark = [&](int x, int y) {
    for (int v = std::max(0, y - kEdgeReachPx); v <= std::min(truth.height - 1, y + kEdgeReachPx); ++v) {
      for (int u = std::max(0, x - kEdgeReachPx); u <= std::min(truth.width - 1, x + kEdgeReachPx); ++u) {
        out.at(u, v) = 1;
      }
    }
  };
  for (int y = 0; y + 1 < truth.height; ++y) {
    for (int x = 0; x + 1 < truth.width; ++x) {
      const float d = truth.at(x, y);
      if (!(std::abs(truth.at(x + 1, y) - d) <= 1) || !(std::abs(truth.at(x, y + 1) - d) <= 1)) mark(x, y);
    }
  }
  return out;
}

bool textured(const Image<std::uint8_t>& picture, int x0, int y0) {
  double sum = 0, sum_of_squares = 0, count = 0;
  for (int y = std::max(0, y0 - 3); y <= std::min(picture.height - 1, y0 + 3); ++y) {
    for (int x = std::max(0, x0 - 3); x <= std::min(picture.width - 1, x0 + 3); ++x) {
      const double grey = picture.at(x, y);
      sum += grey, sum_of_squares += grey * grey, ++count;
    }
  }
  return sum_of_squares / count - sum * sum / (count * count) > kTexturedSigma * kTexturedSigma;
}

bool is_spike(const StereoCamera& camera, int x, int y, double d, double true_d) {
  const double range = triangulate(camera, x, y, d).norm();
  const Eigen::Vector3d truth = triangulate(camera, x, y, true_d);
  const double delta_l =  // Eq. (5)
      kImageSigmaPx * truth.norm() * truth.z() / (camera.focal_px * camera.baseline_m) * std::sqrt(2.0);
  return range < truth.norm() - 3 * (3 * delta_l);
}

void score_errors(std::vector<float> errors, StereoScore& out) {
  double sum = 0;
  for (float& error : errors) sum += error, error = std::abs(error);
  if (errors.empty()) return;
  out.bias_px = sum / static_cast<double>(errors.size());
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  out.median_px = *middle;
}

void score_spikes(const DisparityImage& disparity, const BenchPair& pair, StereoScore& out) {
  const Image<std::uint8_t> edge = near_depth_edge(pair.truth);
  double spikes = 0, away = 0, on_texture = 0, answered_on_texture = 0;
  for (int y = 0; y < disparity.px.height; ++y) {
    for (int x = 0; x < disparity.px.width; ++x) {
      const float d = disparity.px.at(x, y), t = pair.truth.at(x, y);
      if (std::isnan(t)) continue;
      if (pair.visible.at(x, y) && textured(pair.frame.left, x, y))
        ++on_texture, answered_on_texture += !std::isnan(d);
      if (std::isnan(d) || edge.at(x, y)) continue;
      ++away;
      spikes += is_spike(pair.camera, x, y, d, t);
    }
  }
  out.spikes_per_10k = percent(spikes, away) * 100;
  out.textured_density = percent(answered_on_texture, on_texture);
}

}  // namespace

StereoScore score(const DisparityImage& disparity, const BenchPair& pair) {
  StereoScore out;
  double answers = 0, visible = 0, bad_visible = 0, judged = 0, bad_judged = 0;
  std::vector<float> errors;
  for (std::size_t i = 0; i < disparity.px.size(); ++i) {
    const float d = disparity.px.pixels[i];
    const bool answered = !std::isnan(d);
    answers += answered;
    if (pair.truth.empty() || std::isnan(pair.truth.pixels[i])) continue;
    const float error = d - pair.truth.pixels[i];
    const bool good = std::abs(error) <= 2;  // false for NaN
    if (pair.visible.pixels[i]) ++visible, bad_visible += !good;
    if (answered) ++judged, bad_judged += !good;
    if (std::abs(error) <= 1) errors.push_back(error);
  }
  out.density = percent(answers, static_cast<double>(disparity.px.size()));
  out.bad2_visible = percent(bad_visible, visible);
  out.bad2_answered = percent(bad_judged, judged);
  score_errors(std::move(errors), out);
  if (pair.camera.focal_px > 0 && !pair.truth.empty()) score_spikes(disparity, pair, out);
  return out;
}

}  // namespace flogmap
