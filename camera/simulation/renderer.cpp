#include "camera/simulation/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "camera/simulation/lighting.hpp"
#include "camera/simulation/simd.hpp"
#include "camera/simulation/texture_sampler.hpp"

namespace flogmap {
namespace {

constexpr std::uint8_t kNothingGrey = 20;
constexpr int kChunkPx = 16;  // one footprint for so many pixels of a row

/// Where a pixel on an outline is sampled: a turned grid, good for upright and level edges alike.
constexpr std::array<std::array<double, 2>, 4> kSamples{
    {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}}};

/// Keeps the nearer of what is there and the face, for one row.
FLOGMAP_PICTURE_CLONES
void draw_row(float inverse_depth, float per_x, std::int32_t index, int first, int last,
              float* __restrict depths, std::int32_t* __restrict visible) {
  for (int x = first; x < last; ++x) {
    const float w = inverse_depth + per_x * static_cast<float>(x);
    const bool nearer = w > depths[x];
    depths[x] = nearer ? w : depths[x];
    visible[x] = nearer ? index : visible[x];
  }
}

/// Greys of up to kChunkPx neighbouring pixels of one face.
FLOGMAP_PICTURE_CLONES
void shade_chunk(const ScreenFace& face, const MipTexture& texture, int y, int first, int last,
                 std::uint8_t* out) {
  const TextureSampler sampler(texture, footprint_texels(face, 0.5 * (first + last - 1), y));
  const auto w0 = static_cast<float>(face.inverse_depth(first, y));
  const auto u0 = static_cast<float>(face.u_over_depth(first, y)),
             v0 = static_cast<float>(face.v_over_depth(first, y));
  const auto dw = static_cast<float>(face.inverse_depth.per_x),
             du = static_cast<float>(face.u_over_depth.per_x);
  const auto dv = static_cast<float>(face.v_over_depth.per_x);
  const auto u_origin = static_cast<float>(face.u_origin), v_origin = static_cast<float>(face.v_origin);
  std::array<float, kChunkPx> u{}, v{};
  for (int i = 0; i < kChunkPx; ++i) {
    const auto x = static_cast<float>(i);
    const float depth = 1.0F / (w0 + x * dw);
    u[i] = (u0 + x * du) * depth - u_origin;
    v[i] = (v0 + x * dv) * depth - v_origin;
  }
  const std::array<std::int32_t, kChunkPx> grey = sampler(u, v);
  for (int i = 0; i < last - first; ++i) out[i] = static_cast<std::uint8_t>((grey[i] + 128) >> 8);
}

}  // namespace

std::optional<Eigen::Vector3d> shift_at(const Solid& solid, double time_s) {
  if (time_s < solid.from_s || time_s >= solid.until_s) return std::nullopt;
  if (solid.motion.empty()) return Eigen::Vector3d::Zero();
  const auto next = std::find_if(solid.motion.begin(), solid.motion.end(),
                                 [&](const MotionKey& key) { return key.time_s > time_s; });
  if (next == solid.motion.begin()) return next->shift_m;
  const MotionKey& before = *std::prev(next);
  if (next == solid.motion.end()) return before.shift_m;
  const double share = (time_s - before.time_s) / (next->time_s - before.time_s);
  return Eigen::Vector3d(before.shift_m + share * (next->shift_m - before.shift_m));
}

Renderer::Renderer(Scene scene) : scene_(std::move(scene)), faces_(faces_of(scene_)) {
  for (const Face& face : faces_) texels_m_.push_back(texel_size_m(scene_, face));
  textures_ = paint_faces(scene_, faces_);
  visible_ = Image<std::int32_t>(scene_.camera.width_px, scene_.camera.height_px, -1);
}

void Renderer::render(const Eigen::Isometry3d& world_from_camera, double time_s, RenderedView& view) {
  if (view.grey.width != visible_.width || view.grey.height != visible_.height) {
    view.grey = Image<std::uint8_t>(visible_.width, visible_.height);
    view.inverse_depth = Image<float>(visible_.width, visible_.height);
  }
  project_faces(world_from_camera, time_s);
  find_visible(view);
  shade(view);
  smooth_outlines(view);
}

void Renderer::project_faces(const Eigen::Isometry3d& world_from_camera, double time_s) {
  screen_.clear();
  outlines_.clear();
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto shift = shift_at(scene_.solids[faces_[i].solid], time_s);
    if (!shift) continue;
    const Eigen::Isometry3d camera_from_face = world_from_camera.inverse() * Eigen::Translation3d(*shift);
    if (auto screen = project(faces_[i], i, texels_m_[i], camera_from_face, scene_.camera)) {
      screen_.push_back(std::move(*screen));
      outlines_.push_back(static_cast<std::uint32_t>(faces_[i].pattern_seed));
    }
  }
}

void Renderer::find_visible(RenderedView& view) {
  std::fill(view.inverse_depth.pixels.begin(), view.inverse_depth.pixels.end(), 0.0F);
  std::fill(visible_.pixels.begin(), visible_.pixels.end(), -1);
  for (std::size_t k = 0; k < screen_.size(); ++k) {
    const ScreenFace& face = screen_[k];
    for (int y = face.first_row; y <= face.last_row; ++y) {
      const auto [first, last] = face.span(y, visible_.width);
      draw_row(static_cast<float>(face.inverse_depth(0, y)), static_cast<float>(face.inverse_depth.per_x),
               static_cast<std::int32_t>(k), first, last, view.inverse_depth.row(y), visible_.row(y));
    }
  }
}

void Renderer::shade(RenderedView& view) const {
  for (int y = 0; y < visible_.height; ++y) {
    const std::int32_t* visible = visible_.row(y);
    for (int x = 0, end = 0; x < visible_.width; x = end) {
      const std::int32_t k = visible[x];
      const int limit = std::min(x + kChunkPx, visible_.width);
      for (end = x + 1; end < limit && visible[end] == k;) ++end;
      if (k >= 0) {
        shade_chunk(screen_[k], textures_[screen_[k].face], y, x, end, view.grey.row(y) + x);
      } else {
        std::fill(view.grey.row(y) + x, view.grey.row(y) + end, kNothingGrey);
      }
    }
  }
}

bool Renderer::is_outline(int x, int y) const {
  const std::int32_t here = visible_.at(x, y);
  const auto differs = [&](std::int32_t other) {
    return other != here && (other < 0 || here < 0 || outlines_[other] != outlines_[here]);
  };
  return differs(visible_.at(x + 1, y)) || differs(visible_.at(x - 1, y)) || differs(visible_.at(x, y + 1)) ||
         differs(visible_.at(x, y - 1));
}

std::uint8_t Renderer::outline_grey(int x, int y, std::uint8_t otherwise) const {
  std::array<std::int32_t, 9> candidates{};
  std::size_t num_candidates = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const std::int32_t k = visible_.at(x + i, y + j);
      const auto* end = candidates.begin() + num_candidates;
      if (k >= 0 && std::find(candidates.cbegin(), end, k) == end) candidates[num_candidates++] = k;
    }
  }
  std::array<std::int32_t, kSamples.size()> nearest{};
  for (std::size_t i = 0; i < kSamples.size(); ++i) {
    nearest[i] = nearest_at(x + kSamples[i][0], y + kSamples[i][1], {candidates.data(), num_candidates});
  }
  const std::int32_t here = visible_.at(x, y);
  if (std::all_of(nearest.begin(), nearest.end(), [&](std::int32_t k) { return k == here; }))
    return otherwise;
  return mean_grey(x, y, nearest);
}

std::uint8_t Renderer::mean_grey(int x, int y, std::span<const std::int32_t> nearest) const {
  std::int32_t sum = 0;
  std::optional<TextureSampler> sampler;  // of the face before: neighbouring samples mostly share it
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::int32_t k = nearest[i];
    if (k < 0) {
      sum += kNothingGrey * 256;
      continue;
    }
    const ScreenFace& face = screen_[k];
    const double sx = x + kSamples[i][0], sy = y + kSamples[i][1];
    if (!sampler || nearest[i - 1] != k)
      sampler.emplace(textures_[face.face], footprint_texels(face, sx, sy));
    const double depth = 1 / face.inverse_depth(sx, sy);
    const std::array u{static_cast<float>(face.u_over_depth(sx, sy) * depth - face.u_origin)};
    const std::array v{static_cast<float>(face.v_over_depth(sx, sy) * depth - face.v_origin)};
    sum += (*sampler)(u, v)[0];
  }
  return static_cast<std::uint8_t>((sum / static_cast<std::int32_t>(nearest.size()) + 128) >> 8);
}

std::int32_t Renderer::nearest_at(double x, double y, std::span<const std::int32_t> candidates) const {
  std::int32_t nearest = -1;
  double nearest_w = 0;
  for (const std::int32_t k : candidates) {
    const double w = screen_[k].inverse_depth(x, y);
    if (w > nearest_w && screen_[k].contains(x, y)) nearest = k, nearest_w = w;
  }
  return nearest;
}

void Renderer::smooth_outlines(RenderedView& view) const {
  std::vector<std::int32_t> changes(visible_.width);
  for (int y = 1; y + 1 < visible_.height; ++y) {
    const std::int32_t *row = visible_.row(y), *above = visible_.row(y - 1), *below = visible_.row(y + 1);
    for (int x = 1; x + 1 < visible_.width; ++x) {  // without a branch: most pixels are on no outline
      changes[x] = (row[x] ^ row[x - 1]) | (row[x] ^ row[x + 1]) | (row[x] ^ above[x]) | (row[x] ^ below[x]);
    }
    for (int x = 1; x + 1 < visible_.width; ++x) {
      if (changes[x] != 0 && is_outline(x, y)) view.grey.at(x, y) = outline_grey(x, y, view.grey.at(x, y));
    }
  }
}

}  // namespace flogmap
