// Pictures as JPEG and PNG files. OpenCV stays in the .cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/publication.hpp"
#include "server/viewers.hpp"

namespace flogmap {

/// The picture of a report in the wanted size: JPEG for left and right, PNG for the coloured disparity (dark grey
/// where there is none). Nothing if the report does not hold it.
std::optional<EncodedPicture> encode_picture(const PictureReport& report, PictureKey key);

/// An interleaved 8-bit picture (1, 3 RGB or 4 RGBA channels, row 0 on top) as PNG.
std::string encode_png(int width_px, int height_px, int channels, const std::uint8_t* pixels);

}  // namespace flogmap
