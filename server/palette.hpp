// Colours that tell more from less to every eye.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace flogmap {

enum class Palette : std::uint8_t { grey, cividis, viridis };

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Colour&) const = default;
};

using PaletteTable = std::array<Colour, 256>;

/// Nothing if there is no palette of this name.
std::optional<Palette> palette_named(std::string_view name);

/// Colours of 0 .. 255. `grey` runs from white to black, as the paper's maps do; the others from dark to
/// light.
const PaletteTable& table_of(Palette palette);

}  // namespace flogmap
