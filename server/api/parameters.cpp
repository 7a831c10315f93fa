#include "server/api/parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

namespace flogmap {
namespace {

/// FNV-1a, 64 bit.
class Fingerprint {
 public:
  Fingerprint& add(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    value_ = (value_ ^ 0xffU) * 0x100000001b3U;  // "ab","c" is not "a","bc"
    return *this;
  }
  [[nodiscard]] std::string hex() const {
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(value_));
    return digits.data();
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// All that an answer depends on besides the map.
std::string representation_of(const ApiRequest& request, const ServeOptions& options) {
  Fingerprint print;
  print.add(request.path).add(request.accept);
  for (const auto& [name, value] : request.query) print.add(name).add(value);
  print.add(std::to_string(static_cast<int>(options.operators)));
  print.add(std::to_string(options.robot.radius_m)).add(std::to_string(options.robot.height_m));
  return print.hex();
}

[[noreturn]] void refuse(std::string_view name, const std::string& wanted, std::string_view got) {
  throw RefusedRequest(400, "bad-parameter",
                       std::string(name) + " must be " + wanted + ", got '" + std::string(got) + "'", name);
}

std::string_view required(const ApiRequest& request, std::string_view name) {
  const auto value = request.parameter(name);
  if (!value) throw RefusedRequest(400, "missing-parameter", std::string(name) + " is missing", name);
  return *value;
}

}  // namespace

ServedMap& requested_map(const ApiRequest& request, ServerState& state) {
  const std::string& id = request.captures.at(0);
  if (ServedMap* map = state.find_map(id)) return *map;
  if (id == "live") throw RefusedRequest(503, "starting", "the map has not begun yet");
  throw RefusedRequest(404, "no-such-map", "there is no map '" + id + "'; see /api/v1/maps", "id");
}

double parse_number(std::string_view text, std::string_view name) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    refuse(name, "a finite number", text);
  }
  return value;
}

double required_number(const ApiRequest& request, std::string_view name) {
  return parse_number(required(request, name), name);
}

std::optional<double> optional_number(const ApiRequest& request, std::string_view name) {
  const auto value = request.parameter(name);
  return value ? std::optional(parse_number(*value, name)) : std::nullopt;
}

std::int64_t parse_integer(std::string_view text, std::string_view name, std::int64_t least,
                           std::int64_t most) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) {
    refuse(name, "an integer from " + std::to_string(least) + " to " + std::to_string(most), text);
  }
  return value;
}

std::int64_t integer_parameter(const ApiRequest& request, std::string_view name, std::int64_t fallback,
                               std::int64_t least, std::int64_t most) {
  const auto value = request.parameter(name);
  return value ? parse_integer(*value, name, least, most) : fallback;
}

std::optional<Bounds> bbox_parameter(const ApiRequest& request) {
  const auto text = request.parameter("bbox");
  if (!text) return std::nullopt;
  std::vector<double> numbers;
  std::string_view rest = *text;
  for (bool more = true; more && numbers.size() < 5;) {
    const auto comma = rest.find(',');
    numbers.push_back(parse_number(rest.substr(0, comma), "bbox"));
    more = comma != std::string_view::npos;
    rest.remove_prefix(more ? comma + 1 : rest.size());
  }
  if (numbers.size() != 4 || numbers[0] >= numbers[2] || numbers[1] >= numbers[3]) {
    refuse("bbox", "x_min,y_min,x_max,y_max in metres with min < max", *text);
  }
  return Bounds{numbers[0], numbers[1], numbers[2], numbers[3]};
}

std::optional<int> parse_layer(std::string_view text, const MapInfo& info) {
  if (text == "fused") return std::nullopt;
  int layer = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), layer);
  const bool known = error == std::errc{} && end == text.data() + text.size() && layer >= 0 &&
                     layer < info.grid.num_layers();
  if (!known) {
    throw RefusedRequest(404, "no-such-layer", "there is no layer '" + std::string(text) + "'", "layer");
  }
  return layer;
}

PictureChoice picture_choice(const ApiRequest& request, std::optional<int> layer) {
  constexpr std::array<std::string_view, 7> kStyles{"visual",     "planning", "motion", "empty",
                                                    "confidence", "conflict", "changed"};
  PictureChoice choice{layer, Style::visual, Palette::grey};
  if (const auto name = request.parameter("style")) {
    const auto style = std::find(kStyles.begin(), kStyles.end(), *name);
    if (style == kStyles.end()) {
      refuse("style", "visual, planning, motion, empty, confidence, conflict or changed", *name);
    }
    choice.style = static_cast<Style>(style - kStyles.begin());
  }
  if (const auto name = request.parameter("palette")) {
    const auto palette = palette_named(*name);
    if (!palette) refuse("palette", "grey, cividis or viridis", *name);
    choice.palette = *palette;
  }
  return choice;
}

std::string make_etag(std::string_view epoch, std::uint64_t revision, std::string_view representation) {
  std::string tag = "\"";
  tag.append(epoch)
      .append("-")
      .append(std::to_string(revision))
      .append("-")
      .append(representation)
      .append("\"");
  return tag;
}

std::string etag_of(const ServedMap& map, const ApiRequest& request, const ServeOptions& options) {
  return make_etag(map.epoch(), map.revision(), representation_of(request, options));
}

std::string etag_with_path(const ServedMap& map, const ApiRequest& request, const ServeOptions& options) {
  return make_etag(map.epoch(), map.revision(),
                   representation_of(request, options) + "." + std::to_string(map.path_version()));
}

std::string etag_of_text(std::string_view text) {
  std::string tag = "\"";
  return tag.append(Fingerprint().add(text).hex()).append("\"");
}

bool is_known(const ApiRequest& request, std::string_view etag) {
  return etag_matches(request.if_none_match, etag);
}

ApiResponse nothing_new(std::string etag) {
  ApiResponse response;
  response.etag = std::move(etag);
  response.cache_control = kLiveCache;
  return response;
}

}  // namespace flogmap
