#include "server/palette.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace flogmap {
namespace {

/// Cividis (Nunez, Anderton, Renslow 2018, doi:10.1371/journal.pone.0199239) at eighths of its range.
constexpr std::array<Colour, 9> kCividis{{{0, 34, 78},
                                          {27, 57, 109},
                                          {67, 78, 108},
                                          {97, 101, 111},
                                          {125, 124, 120},
                                          {155, 148, 119},
                                          {188, 174, 108},
                                          {222, 203, 85},
                                          {254, 232, 56}}};

/// Viridis (van der Walt and Smith 2015) at eighths of its range.
constexpr std::array<Colour, 9> kViridis{{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

std::uint8_t between(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

PaletteTable interpolated(std::span<const Colour> points) {
  PaletteTable table;
  for (int value = 0; value < 256; ++value) {
    const double at = value / 255.0 * static_cast<double>(points.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), points.size() - 2);
    const double share = at - static_cast<double>(below);
    const Colour a = points[below], b = points[below + 1];
    table[value] = {between(a.r, b.r, share), between(a.g, b.g, share), between(a.b, b.b, share)};
  }
  return table;
}

PaletteTable white_to_black() {
  PaletteTable table;
  for (int value = 0; value < 256; ++value) {
    const auto grey = static_cast<std::uint8_t>(255 - value);
    table[value] = {grey, grey, grey};
  }
  return table;
}

}  // namespace

std::optional<Palette> palette_named(std::string_view name) {
  if (name == "grey") return Palette::grey;
  if (name == "cividis") return Palette::cividis;
  if (name == "viridis") return Palette::viridis;
  return std::nullopt;
}

const PaletteTable& table_of(Palette palette) {
  static const PaletteTable grey = white_to_black();
  static const PaletteTable cividis = interpolated(kCividis);
  static const PaletteTable viridis = interpolated(kViridis);
  switch (palette) {
    case Palette::cividis:
      return cividis;
    case Palette::viridis:
      return viridis;
    case Palette::grey:
      break;
  }
  return grey;
}

}  // namespace flogmap
