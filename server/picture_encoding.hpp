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

/// Values 0 .. 255 in the colours of a palette as PNG, at most `max_width_px` wide (0: as it is). Where
/// several values fall on one pixel the largest is shown, so that no obstacle gets lost.
std::string encode_coloured_png(const Image<std::uint8_t>& values, Palette palette, int max_width_px);

}  // namespace flogmap
