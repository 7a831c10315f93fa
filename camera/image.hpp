// The only pixel containers that appear in headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flogmap {

/// Row-major image of `width` x `height` pixels without padding; pixel (x, y) is `pixels[y * width + x]`.
template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int width_px, int height_px, T value = T{})
      : width(width_px), height(height_px), pixels(static_cast<std::size_t>(width_px) * height_px, value) {}

  [[nodiscard]] bool empty() const { return pixels.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels.size(); }
  [[nodiscard]] T* row(int y) { return pixels.data() + static_cast<std::size_t>(y) * width; }
  [[nodiscard]] const T* row(int y) const { return pixels.data() + static_cast<std::size_t>(y) * width; }
  [[nodiscard]] T& at(int x, int y) { return row(y)[x]; }
  [[nodiscard]] const T& at(int x, int y) const { return row(y)[x]; }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  bool operator==(const Image&) const = default;
};

/// A picture as a camera or a file delivers it: `channels` is 1 (grey) or 3 (blue, green, red interleaved),
/// `bits` is 8 or 16. With 16 bits each sample takes two bytes in the machine's byte order.
struct Picture {
  int width = 0;
  int height = 0;
  int channels = 1;
  int bits = 8;
  std::vector<std::uint8_t> bytes;  // height * width * channels * bits / 8

  [[nodiscard]] bool empty() const { return bytes.empty(); }
  bool operator==(const Picture&) const = default;
};

}  // namespace flogmap
