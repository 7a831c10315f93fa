// Pictures as JPEG and PNG files. OpenCV stays in the .cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "camera/image.hpp"
#include "server/palette.hpp"
#include "server/picture_key.hpp"
#include "server/publication.hpp"
#include "server/wire.hpp"

namespace flogmap {

/// The picture of a report in the wanted size: JPEG for left and right, PNG for the coloured disparity (dark
/// grey where there is none). Nothing if the report does not hold it.
std::optional<EncodedPicture> encode_picture(const PictureReport& report, PictureKey key);

struct PictureSize {
  std::int64_t width = 0, height = 0;  // pixels
};

/// A picture of this size made at most `max_width_px` wide (0: as it is), its shape kept, never larger.
PictureSize fitted_size(std::int64_t width, std::int64_t height, std::int64_t max_width_px);

/// Every pixel is the largest of those that it covers, so that no obstacle gets lost. The size must be at
/// least 1 x 1 and not larger.
Image<std::uint8_t> shrunk_to_largest(const Image<std::uint8_t>& image, PictureSize size);

/// Values 0 .. 255 in the colours of a palette as PNG.
std::string encode_coloured_png(const Image<std::uint8_t>& values, Palette palette);

}  // namespace flogmap
