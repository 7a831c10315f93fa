// Mapped views, small enough to keep thousands of them: what a map is built from anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "mapping/view.hpp"

namespace flogmap {

/// Rounds to 1/64 px, as a stored view has it; what is no positive number below 1024 px becomes NaN.
void round_disparity(DisparityImage& disparity);

/// A disparity image without loss, if it was rounded before; else rounded. About a byte per pixel or less.
[[nodiscard]] std::vector<std::uint8_t> pack_disparity(const DisparityImage& disparity);

/// Its inverse. Throws std::invalid_argument if the bytes are not those of an image of this size.
[[nodiscard]] DisparityImage unpack_disparity(const std::vector<std::uint8_t>& bytes, int width, int height);

/// The oldest go when there are too many bytes. Pictures are not kept: a map does not need them.
class ViewStore {
 public:
  explicit ViewStore(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// `view.world_from_camera`: as odometry has it.
  void add(const View& view);

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  [[nodiscard]] std::size_t num_bytes() const { return num_bytes_; }

  /// Oldest first.
  [[nodiscard]] View view(std::size_t number) const;
  [[nodiscard]] std::int64_t timestamp_ns(std::size_t number) const { return views_.at(number).timestamp_ns; }
  [[nodiscard]] int segment(std::size_t number) const { return views_.at(number).segment; }

  /// It must go: more bytes are held than may be, and it is not the only one.
  [[nodiscard]] bool is_full() const { return num_bytes_ > max_bytes_ && views_.size() > 1; }
  void drop_oldest();
  void clear();

 private:
  struct Packed {
    std::int64_t timestamp_ns = 0;
    int segment = 0;
    SE3 world_from_camera;
    int width = 0, height = 0;
    std::vector<std::uint8_t> disparity;
  };

  std::size_t max_bytes_;
  std::size_t num_bytes_ = 0;
  std::deque<Packed> views_;
};

}  // namespace flogmap
