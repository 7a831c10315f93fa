#include "mapping/loop/view_store.hpp"

#include <libdeflate.h>

#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace flogmap {
namespace {

constexpr float kUnitsPerPx = 64;
constexpr std::uint16_t kNoMatch = 0;
constexpr int kFast = 1;  // libdeflate's level: a view must not hold up the map
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Free {
  void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
  void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
};

std::uint16_t to_units(float disparity_px) {
  const float units = std::floor(disparity_px * kUnitsPerPx + 0.5F);
  return units >= 1 && units <= 65535 ? static_cast<std::uint16_t>(units) : kNoMatch;  // NaN: neither
}

float to_px(std::uint16_t units) {
  return units == kNoMatch ? kNaN : static_cast<float>(units) / kUnitsPerPx;
}

/// Steps along the row, small ones as small numbers whatever their sign; low bytes first, then high bytes.
std::vector<std::uint8_t> plain_bytes(const DisparityImage& disparity) {
  const std::size_t count = disparity.px.size();
  std::vector<std::uint8_t> bytes(2 * count);
  std::uint16_t last = kNoMatch;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t now = to_units(disparity.px.pixels[i]);
    const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(now - last));
    const auto code = static_cast<std::uint16_t>((step << 1) ^ (step >> 15));
    bytes[i] = static_cast<std::uint8_t>(code & 0xff);
    bytes[count + i] = static_cast<std::uint8_t>(code >> 8);
    last = now;
  }
  return bytes;
}

}  // namespace

void round_disparity(DisparityImage& disparity) {
  for (float& d : disparity.px.pixels) d = to_px(to_units(d));
}

std::vector<std::uint8_t> pack_disparity(const DisparityImage& disparity) {
  const std::vector<std::uint8_t> plain = plain_bytes(disparity);
  const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(kFast));
  if (!compressor) throw std::bad_alloc();
  std::vector<std::uint8_t> packed(libdeflate_deflate_compress_bound(compressor.get(), plain.size()));
  packed.resize(libdeflate_deflate_compress(compressor.get(), plain.data(), plain.size(), packed.data(),
                                            packed.size()));
  packed.shrink_to_fit();
  return packed;
}

DisparityImage unpack_disparity(const std::vector<std::uint8_t>& bytes, int width, int height) {
  const std::unique_ptr<libdeflate_decompressor, Free> decompressor(libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  DisparityImage disparity{Image<float>(width, height)};
  const std::size_t count = disparity.px.size();
  std::vector<std::uint8_t> plain(2 * count);
  const auto result = libdeflate_deflate_decompress(decompressor.get(), bytes.data(), bytes.size(),
                                                    plain.data(), plain.size(), nullptr);
  if (result != LIBDEFLATE_SUCCESS) throw std::invalid_argument("a stored disparity image is damaged");
  std::uint16_t value = kNoMatch;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned code = plain[i] | (unsigned{plain[count + i]} << 8U);
    const unsigned step = (code >> 1U) ^ (0U - (code & 1U));
    value = static_cast<std::uint16_t>(value + step);
    disparity.px.pixels[i] = to_px(value);
  }
  return disparity;
}

void ViewStore::add(const View& view) {
  const Image<float>& px = view.disparity.px;
  views_.push_back({view.timestamp_ns, view.segment, view.world_from_camera, px.width, px.height,
                    pack_disparity(view.disparity)});
  num_bytes_ += views_.back().disparity.size();
}

View ViewStore::view(std::size_t number) const {
  const Packed& packed = views_.at(number);
  View view;
  view.timestamp_ns = packed.timestamp_ns;
  view.world_from_camera = packed.world_from_camera;
  view.disparity = unpack_disparity(packed.disparity, packed.width, packed.height);
  view.segment = packed.segment;
  return view;
}

void ViewStore::drop_oldest() {
  num_bytes_ -= views_.front().disparity.size();
  views_.pop_front();
}

void ViewStore::clear() {
  views_.clear();
  num_bytes_ = 0;
}

}  // namespace flogmap
