#include "mapping/map_truth.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/picture_files.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kSmallestCell_m = 0.001, kLargestCell_m = 10;  // of any map

Image<std::uint8_t> read_mask(const fs::path& file) {
  const ReadPicture read = read_picture(file);
  if (!read.problem.empty()) throw std::runtime_error(read.problem);
  if (read.picture.channels != 1 || read.picture.bits != 8) {
    throw std::runtime_error(file.string() + ": must be a grey picture with 8 bits");
  }
  Image<std::uint8_t> mask(read.picture.width, read.picture.height);
  mask.pixels = read.picture.bytes;
  return mask;
}

/// The size that a description gives, if it does, is that of its picture.
void check_size(const json& document, const Image<std::uint8_t>& picture, const fs::path& file) {
  const int width = document.value("width", picture.width), height = document.value("height", picture.height);
  if (width == picture.width && height == picture.height) return;
  throw std::runtime_error(file.string() + ": width and height are " + std::to_string(width) + " and " +
                           std::to_string(height) + ", but the picture is " + std::to_string(picture.width) +
                           "x" + std::to_string(picture.height));
}

void read_description(const fs::path& file, LayerTruth& truth) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  try {
    const json document = json::parse(in);
    const auto origin = document.at("origin").get<std::vector<double>>();
    if (origin.size() != 2) throw std::runtime_error(file.string() + ": origin must be [x, y] in metres");
    truth.solid.origin_x_m = origin[0];
    truth.solid.origin_y_m = origin[1];
    truth.solid.cell_size_m = document.at("cell").get<double>();
    const auto z = document.value("z", std::vector<double>{0, 0});
    if (z.size() != 2) throw std::runtime_error(file.string() + ": z must be [low, high] in metres");
    truth.low_m = z[0];
    truth.high_m = z[1];
    if (!(truth.solid.cell_size_m >= kSmallestCell_m && truth.solid.cell_size_m <= kLargestCell_m)) {
      throw std::runtime_error(file.string() + ": cell must be 0.001 to 10 m, is " + document["cell"].dump());
    }
    check_size(document, truth.solid.solid, file);
  } catch (const json::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what() + "; needs origin [x, y] and cell, metres");
  }
}

}  // namespace

LayerTruth read_layer_truth(const fs::path& folder, int layer) {
  const std::string number = std::to_string(layer);
  LayerTruth truth;
  truth.solid.solid = read_mask(folder / ("layer_" + number + ".png"));
  read_description(folder / ("layer_" + number + ".json"), truth);
  for (const char* kind : {"surface_", "seen_"}) {
    const fs::path seen = folder / (kind + number + ".png");
    if (!fs::exists(seen)) continue;
    truth.seen_surfaces = read_mask(seen);
    if (truth.seen_surfaces->width != truth.solid.solid.width ||
        truth.seen_surfaces->height != truth.solid.solid.height) {
      throw std::runtime_error(seen.string() + ": must have the size of layer_" + number + ".png");
    }
    return truth;
  }
  return truth;
}

}  // namespace flogmap
