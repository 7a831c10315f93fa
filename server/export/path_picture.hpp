#pragma once

#include "camera/image.hpp"
#include "mapping/flog/map_value.hpp"
#include "server/export/picture_file.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// The fused map with the camera's path, as a figure to look at: enlarged by a whole factor until it fills
/// about a screen, north up. White is free, bluish grey never seen, darker towards black occupied (M, with
/// cells trusted after an eighth of N_K, so that a short recording can be read). The path runs from a green
/// dot to a red square, with a tick where the camera looked now and then, and breaks where the camera was
/// lost. Below: a scale bar and what the colours mean.
Image<Rgb> path_picture(const StoredMap& map, Operators operators);

}  // namespace flogmap
