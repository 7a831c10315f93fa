#include "tests/server/client_frames.hpp"

#include "flogmap/v1/stream.pb.h"

namespace flogmap {

std::string hello_frame(std::uint32_t version) {
  v1::ClientMessage message;
  message.mutable_hello()->add_versions(version);
  return message.SerializeAsString();
}

std::string hello_frame(const Resume& resume) {
  v1::ClientMessage message;
  message.mutable_hello()->add_versions(kProtocolVersion);
  message.mutable_hello()->mutable_resume()->set_epoch(resume.epoch);
  message.mutable_hello()->mutable_resume()->set_rev(resume.revision);
  message.mutable_hello()->mutable_resume()->set_trajectory_length(resume.trajectory_length);
  return message.SerializeAsString();
}

std::string subscribe_frame(const Subscribe& wish) {
  v1::ClientMessage message;
  v1::Subscribe& subscribe = *message.mutable_subscribe();
  for (const int layer : wish.tiles.layers) subscribe.add_layers(static_cast<std::uint32_t>(layer));
  subscribe.set_planes(wish.tiles.planes == Planes::value ? v1::PLANES_VALUE : v1::PLANES_EVIDENCE);
  for (const ImageRequest& request : wish.images) {
    v1::ImageRequest& image = *subscribe.add_images();
    image.set_stream(static_cast<v1::ImageStream>(static_cast<int>(request.stream) + 1));
    image.set_max_fps(request.max_fps);
    image.set_max_width(static_cast<std::uint32_t>(request.max_width_px));
  }
  subscribe.set_pose_hz(wish.pose_hz);
  subscribe.set_features(wish.features);
  return message.SerializeAsString();
}

std::string viewport_frame(const Viewport& viewport) {
  v1::ClientMessage message;
  v1::Bounds& bounds = *message.mutable_viewport()->mutable_bounds();
  bounds.set_x_min(viewport.bounds.x_min);
  bounds.set_y_min(viewport.bounds.y_min);
  bounds.set_x_max(viewport.bounds.x_max);
  bounds.set_y_max(viewport.bounds.y_max);
  message.mutable_viewport()->set_level(viewport.level);
  return message.SerializeAsString();
}

std::string ack_frame(std::uint64_t bytes) {
  v1::ClientMessage message;
  message.mutable_ack()->set_bytes(bytes);
  return message.SerializeAsString();
}

std::string inspect_frame(double x_m, double y_m) {
  v1::ClientMessage message;
  message.mutable_inspect_cell()->set_x(x_m);
  message.mutable_inspect_cell()->set_y(y_m);
  return message.SerializeAsString();
}

std::string ping_frame(std::uint64_t nonce) {
  v1::ClientMessage message;
  message.mutable_ping()->set_nonce(nonce);
  return message.SerializeAsString();
}

}  // namespace flogmap
