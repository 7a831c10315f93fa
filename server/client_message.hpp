// What a page may say on the stream, as plain values; proto/flogmap/v1/stream.proto says what each means.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/tile_key.hpp"

namespace flogmap {

inline constexpr std::uint32_t kProtocolVersion = 1;

struct Resume {
  std::string epoch;
  std::uint64_t revision = 0;
  std::uint64_t trajectory_length = 0;
};

struct Hello {
  std::vector<std::uint32_t> versions;
  std::optional<Resume> resume;
};

enum class Planes : std::uint8_t { value, evidence };

enum class ImageStream : std::uint8_t { left, right, disparity };
inline constexpr int kNumImageStreams = 3;

struct ImageRequest {
  ImageStream stream = ImageStream::left;
  double max_fps = 0;
  int max_width_px = 0;  // 0: full size
};

/// Which tiles a client wants, and how.
struct TileChoice {
  std::vector<int> layers;  // rising ids; empty: all
  Planes planes = Planes::value;
  bool operator==(const TileChoice&) const = default;
};

struct Subscribe {
  TileChoice tiles;
  std::vector<ImageRequest> images;
  double pose_hz = 0;
  bool features = false;
};

struct Viewport {
  Bounds bounds;
  std::uint32_t level = 0;
  bool operator==(const Viewport&) const = default;
};

struct Ack {
  std::uint64_t revision = 0;
  std::uint64_t bytes = 0;
};

struct Forget {
  std::vector<TileKey> keys;
};

struct InspectCell {
  double x_m = 0;
  double y_m = 0;
};

struct Ping {
  std::uint64_t nonce = 0;
};

using ClientMessage = std::variant<Hello, Subscribe, Viewport, Ack, Forget, InspectCell, Ping>;

/// Nothing if the bytes are not a client message or a value is impossible (not finite, unknown plane or
/// stream).
std::optional<ClientMessage> decode_client_message(std::string_view bytes);

}  // namespace flogmap
