// Bytes of a page into values. Nothing here is trusted.
#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>

#include "server/wire_values.hpp"

namespace flogmap {
namespace {

std::optional<ClientMessage> read(const v1::Hello& from) {
  Hello hello{{from.versions().begin(), from.versions().end()}, std::nullopt};
  if (from.has_resume()) {
    hello.resume = Resume{from.resume().epoch(), from.resume().rev(), from.resume().trajectory_length()};
  }
  return hello;
}

std::optional<ImageRequest> read(const v1::ImageRequest& from) {
  if (from.stream() < v1::IMAGE_STREAM_LEFT || from.stream() > v1::IMAGE_STREAM_DISPARITY)
    return std::nullopt;
  if (!std::isfinite(from.max_fps()) || from.max_fps() < 0) return std::nullopt;
  const auto stream = static_cast<ImageStream>(from.stream() - v1::IMAGE_STREAM_LEFT);
  return ImageRequest{stream, from.max_fps(), static_cast<int>(std::min(from.max_width(), 1U << 16U))};
}

std::optional<ClientMessage> read(const v1::Subscribe& from) {
  Subscribe subscribe;
  constexpr std::uint32_t kMaxLayerId = 255;
  for (const std::uint32_t layer : from.layers()) {
    if (layer > kMaxLayerId) return std::nullopt;
    subscribe.tiles.layers.push_back(static_cast<int>(layer));
  }
  auto& layers = subscribe.tiles.layers;
  std::sort(layers.begin(), layers.end());
  layers.erase(std::unique(layers.begin(), layers.end()), layers.end());
  if (from.planes() != v1::PLANES_VALUE && from.planes() != v1::PLANES_EVIDENCE) return std::nullopt;
  subscribe.tiles.planes = from.planes() == v1::PLANES_VALUE ? Planes::value : Planes::evidence;
  for (const v1::ImageRequest& image : from.images()) {
    const auto request = read(image);
    if (!request || subscribe.images.size() == kNumImageStreams) return std::nullopt;
    subscribe.images.push_back(*request);
  }
  if (!std::isfinite(from.pose_hz()) || from.pose_hz() < 0) return std::nullopt;
  subscribe.pose_hz = from.pose_hz();
  subscribe.features = from.features();
  return subscribe;
}

std::optional<ClientMessage> read(const v1::Viewport& from) {
  const v1::Bounds& b = from.bounds();
  const bool finite = std::isfinite(b.x_min()) && std::isfinite(b.y_min()) && std::isfinite(b.x_max()) &&
                      std::isfinite(b.y_max());
  if (!finite || b.x_min() > b.x_max() || b.y_min() > b.y_max()) return std::nullopt;
  const auto level = std::min(from.level(), static_cast<std::uint32_t>(kOverviewLevels - 1));
  return Viewport{{b.x_min(), b.y_min(), b.x_max(), b.y_max()}, level};
}

std::optional<ClientMessage> read(const v1::Forget& from) {
  Forget forget;
  for (const v1::TileKey& key : from.keys()) forget.keys.push_back({key.level(), key.x(), key.y()});
  return forget;
}

/// Protobuf writes a line on stderr for each text that is no UTF-8: a stranger could fill the log with them.
/// What is refused is said where the connection is closed.
void silence_protobuf() {
  static const bool silenced = (google::protobuf::SetLogHandler(nullptr), true);
  (void)silenced;
}

}  // namespace

std::optional<ClientMessage> decode_client_message(std::string_view bytes) {
  silence_protobuf();
  v1::ClientMessage message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  switch (message.message_case()) {
    case v1::ClientMessage::kHello:
      return read(message.hello());
    case v1::ClientMessage::kSubscribe:
      return read(message.subscribe());
    case v1::ClientMessage::kViewport:
      return read(message.viewport());
    case v1::ClientMessage::kAck:
      return Ack{message.ack().rev(), message.ack().bytes()};
    case v1::ClientMessage::kForget:
      return read(message.forget());
    case v1::ClientMessage::kInspectCell: {
      const double x = message.inspect_cell().x(), y = message.inspect_cell().y();
      if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
      return InspectCell{x, y};
    }
    case v1::ClientMessage::kPing:
      return Ping{message.ping().nonce()};
    case v1::ClientMessage::MESSAGE_NOT_SET:
      break;
  }
  return std::nullopt;
}

}  // namespace flogmap
