#include "tests/server/wire_samples.hpp"

#include <google/protobuf/util/json_util.h>

#include <stdexcept>

#include "flogmap/v1/stream.pb.h"
#include "server/tile_planes.hpp"
#include "server/wire.hpp"

namespace flogmap {
namespace {

MapHeader sample_header() {
  MapHeader header;
  header.epoch = "0123456789abcdef";
  header.revision = 4711;
  header.info.grid.layer_bounds_m = {0.05, 0.75, 1.45};
  header.info.full_confidence_rays = {120, 140.5F};
  header.info.min_rays = 8;
  header.operators = Operators::minmax;
  header.bounds = Bounds{-2.56, -1.28, 3.84, 5.12};
  header.camera = {435.2, 367.2, 252.2, 0.11, 752, 480};
  return header;
}

SE3 sample_pose() {
  SE3 pose = SE3::Identity();
  pose.linear() = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(1.25, -2.5, 0.75);
  return pose;
}

TrackingReport sample_tracking() {
  TrackingReport report;
  report.timestamp_ns = 1'403'636'579'763'555'584;
  report.world_from_camera = sample_pose();
  report.tracking.state = TrackingState::weak;
  for (int i = 0; i < 36; ++i) report.tracking.covariance(i / 6, i % 6) = i / 64.0;
  report.tracking.reason = "few corners (31 of 40 wanted)";
  report.tracking.matches = {{{10, 20}, {11, 21}, 5, true}, {{30, 40}, {33, 40.5F}, 6, false}};
  report.tracking.corners_px = {{11, 21}, {33, 40.5F}, {50.25F, 60.75F}};
  return report;
}

std::vector<TrajectoryEntry> sample_trajectory() {
  SE3 second = sample_pose();
  second.translation().x() = 1.5;
  return {{1'403'636'579'763'555'584, sample_pose(), TrackingState::ok, true},
          {1'403'636'579'813'555'456, second, TrackingState::weak, false}};
}

EncodedPicture sample_picture() {
  EncodedPicture picture;
  picture.stream = ImageStream::disparity;
  picture.timestamp_ns = 1'403'636'579'763'555'584;
  picture.media_type = "image/png";
  picture.data = std::string("\x89PNG\0\x01\xff", 7);
  picture.scale_max_px = 64;
  picture.width_px = 320;
  picture.height_px = 204;
  picture.full_width_px = 752;
  picture.full_height_px = 480;
  return picture;
}

StatusReport sample_status() {
  StatusReport status;
  status.frames_per_s = 19.5;
  status.frames = 100;
  status.tracked = 97;
  status.lost = 3;
  status.mapped_views = 41;
  status.loops = 2;
  status.dropped_frames = 5;
  status.processor_celsius = 61.5;
  status.skipped_frames = 1;
  status.stages = {{"read", 1.5, 2.5}, {"map", 20.25, 31.75}};
  status.warnings = {"too dark: open the aperture or add light"};
  status.alignment = "gravity";
  return status;
}

CellColumn sample_column() {
  CellColumn column{1.01, -2.03, "0123456789abcdef", 4700, {}};
  column.layers = {{0, 0.25, 0.5, 0.75, 90, 0.4375, 0.375, 0.625, 0.375, 0.125},
                   {1, 0, 0, 0, 0, 0, 0, 1, 0, 0}};
  return column;
}

PlaneBytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string sample_batch(Planes planes) {
  std::vector<Bytes> layers;
  for (int layer = 0; layer < 2; ++layer) {
    const bool evidence = planes == Planes::evidence;
    const std::string data =
        deflate_planes(bytes_of(evidence ? sample_evidence(layer) : sample_value(layer)));
    // The change plane stands in layer 0 alone: nothing changed lately in layer 1.
    const std::string change =
        evidence && layer == 0 ? deflate_planes(bytes_of(sample_change())) : std::string();
    layers.push_back(to_shared(encode_layer_planes(layer, planes, data, change)));
  }
  const Bytes near = to_shared(encode_tile({0, -3, 5}, 4700, layers));
  const Bytes far = to_shared(encode_tile({2, 1, -1}, 4711, std::vector<Bytes>{layers[1]}));
  return encode_tile_batch(4711, true, std::vector<Bytes>{near, far}, std::vector<TileKey>{{0, 7, -8}});
}

WireSample client(const std::string& name, const v1::ClientMessage& message) {
  return {"client_" + name, message.SerializeAsString(), false};
}

v1::ClientMessage sample_subscribe() {
  v1::ClientMessage message;
  v1::Subscribe& subscribe = *message.mutable_subscribe();
  subscribe.add_layers(0);
  subscribe.add_layers(2);
  subscribe.set_planes(v1::PLANES_EVIDENCE);
  v1::ImageRequest& image = *subscribe.add_images();
  image.set_stream(v1::IMAGE_STREAM_DISPARITY);
  image.set_max_fps(7.5);
  image.set_max_width(320);
  subscribe.set_pose_hz(20);
  subscribe.set_features(true);
  return message;
}

v1::ClientMessage sample_hello() {
  v1::ClientMessage message;
  message.mutable_hello()->add_versions(1);
  message.mutable_hello()->mutable_resume()->set_epoch("0123456789abcdef");
  message.mutable_hello()->mutable_resume()->set_rev(4711);
  message.mutable_hello()->mutable_resume()->set_trajectory_length(2);
  return message;
}

v1::ClientMessage sample_viewport() {
  v1::ClientMessage message;
  v1::Bounds& bounds = *message.mutable_viewport()->mutable_bounds();
  bounds.set_x_min(-1.5);
  bounds.set_y_min(-2.5);
  bounds.set_x_max(3.5);
  bounds.set_y_max(4.5);
  message.mutable_viewport()->set_level(1);
  return message;
}

}  // namespace

std::string sample_evidence(int layer) {
  std::string E, O, K;
  for (int y = 0; y < kTileSide; ++y) {
    for (int x = 0; x < kTileSide; ++x) {
      const int e = (x + 2 * y + 7 * layer) % 256;
      E.push_back(static_cast<char>(e));
      O.push_back(static_cast<char>((255 - e) / 2));
      K.push_back(static_cast<char>(4 * x));
    }
  }
  return E + O + K;
}

std::string sample_change() {
  std::string change;
  for (int i = 0; i < kTileColumns; ++i) change.push_back(static_cast<char>(i / kTileSide));
  return change;
}

std::string sample_value(int layer) {
  std::string M;
  for (int i = 0; i < kTileColumns; ++i) {
    M.push_back(static_cast<char>((i % kTileSide) * (i / kTileSide) % 251 + layer));
  }
  return M;
}

std::vector<WireSample> server_samples() {
  PlaybackState playback{
      .seekable = true, .position_s = 12.5, .duration_s = 182, .rate = 2, .paused = true, .loop = true};
  const auto path = sample_trajectory();
  ServingStatus serving{SessionState::paused, 321, 31'555'584, 3};
  TrackingReport lost;
  lost.timestamp_ns = 1'403'636'579'813'555'456;
  lost.tracking.state = TrackingState::lost;
  lost.tracking.reason = "too few corners (12 of 40 needed)";
  return {{"server_welcome", encode_welcome(sample_header(), {}, "control", "0.1.0")},
          {"server_snapshot_begin", encode_snapshot_begin(2, 6000)},
          {"server_tile_batch_evidence", sample_batch(Planes::evidence), true},
          {"server_tile_batch_value", sample_batch(Planes::value), true},
          {"server_snapshot_end", encode_snapshot_end(4711)},
          {"server_reset", encode_reset(sample_header(), "reset by operator")},
          {"server_pose", encode_pose(sample_tracking(), 17.5)},
          {"server_pose_lost", encode_pose(lost, 0)},
          {"server_trajectory_append", encode_trajectory_append(40, path)},
          {"server_trajectory_rewrite", encode_trajectory_rewrite(path, "loop closed")},
          {"server_image_frame", encode_image(sample_picture())},
          {"server_features", encode_features(sample_tracking())},
          {"server_status", encode_status(sample_status(), serving)},
          {"server_playback", encode_playback(playback)},
          {"server_cell_column", encode_cell_column(sample_column())},
          {"server_problem", encode_problem("out-of-range", "no cell lies so far out")},
          {"server_goodbye", encode_goodbye("shutting down", 2)},
          {"server_pong", encode_pong(77)}};
}

std::vector<WireSample> client_samples() {
  v1::ClientMessage ack, forget, inspect, ping;
  ack.mutable_ack()->set_rev(4711);
  ack.mutable_ack()->set_bytes(262'144);
  v1::TileKey& key = *forget.mutable_forget()->add_keys();
  key.set_level(1);
  key.set_x(-4);
  key.set_y(9);
  inspect.mutable_inspect_cell()->set_x(1.01);
  inspect.mutable_inspect_cell()->set_y(-2.03);
  ping.mutable_ping()->set_nonce(77);
  return {client("hello", sample_hello()),
          client("subscribe", sample_subscribe()),
          client("viewport", sample_viewport()),
          client("ack", ack),
          client("forget", forget),
          client("inspect_cell", inspect),
          client("ping", ping)};
}

std::string to_json(const WireSample& sample) {
  v1::ServerMessage server;
  v1::ClientMessage client;
  google::protobuf::Message& message =
      sample.name.starts_with("server_") ? static_cast<google::protobuf::Message&>(server) : client;
  if (!message.ParseFromString(sample.bytes)) throw std::runtime_error(sample.name + ": cannot be parsed");
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(message, &json, options).ok())
    throw std::runtime_error(sample.name);
  return json;
}

}  // namespace flogmap
