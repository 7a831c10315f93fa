#include "server/wire.hpp"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/wire_format_lite.h>

#include "server/wire_values.hpp"

namespace flogmap {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedOutputStream;

std::string bytes_of(const google::protobuf::MessageLite& message) { return message.SerializeAsString(); }

std::size_t bytes_field_size(int field, std::size_t size) {
  return CodedOutputStream::VarintSize32(static_cast<std::uint32_t>(field) << 3U) +
         CodedOutputStream::VarintSize32(static_cast<std::uint32_t>(size)) + size;
}

/// Writes what protobuf would write for sub-messages, without parsing and copying them once more.
class FieldWriter {
 public:
  explicit FieldWriter(std::string& out) : stream_(&out), coded_(&stream_) {}

  void begin(int field, std::size_t size) {
    coded_.WriteTag(WireFormatLite::MakeTag(field, WireFormatLite::WIRETYPE_LENGTH_DELIMITED));
    coded_.WriteVarint32(static_cast<std::uint32_t>(size));
  }
  void raw(const std::string& bytes) { coded_.WriteRaw(bytes.data(), static_cast<int>(bytes.size())); }
  void bytes(int field, const std::string& value) {
    begin(field, value.size());
    raw(value);
  }

 private:
  google::protobuf::io::StringOutputStream stream_;
  CodedOutputStream coded_;
};

}  // namespace

std::string encode_welcome(const MapHeader& map, const WireLimits& limits, std::string_view role,
                           std::string_view server_version) {
  v1::ServerMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
  welcome.set_version(kProtocolVersion);
  fill(*welcome.mutable_map(), map);
  welcome.mutable_limits()->set_max_unacknowledged_bytes(limits.max_unacknowledged_bytes);
  welcome.mutable_limits()->set_max_batch_bytes(limits.max_batch_bytes);
  welcome.mutable_limits()->set_max_client_frame_bytes(limits.max_client_frame_bytes);
  welcome.set_role(std::string(role));
  fill(*welcome.mutable_camera(), map.camera);
  welcome.set_server_version(std::string(server_version));
  return bytes_of(message);
}

std::string encode_snapshot_begin(std::uint64_t tiles, std::uint64_t bytes) {
  v1::ServerMessage message;
  message.mutable_snapshot_begin()->set_tiles(tiles);
  message.mutable_snapshot_begin()->set_bytes(bytes);
  return bytes_of(message);
}

std::string encode_snapshot_end(std::uint64_t revision) {
  v1::ServerMessage message;
  message.mutable_snapshot_end()->set_rev(revision);
  return bytes_of(message);
}

std::string encode_reset(const MapHeader& map, std::string_view reason) {
  v1::ServerMessage message;
  fill(*message.mutable_reset()->mutable_map(), map);
  message.mutable_reset()->set_reason(std::string(reason));
  return bytes_of(message);
}

std::string encode_pose(const TrackingReport& report, double age_ms) {
  v1::ServerMessage message;
  v1::Pose& pose = *message.mutable_pose();
  pose.set_time_ns(report.timestamp_ns);
  pose.set_state(to_proto(report.tracking.state));
  if (report.world_from_camera) {
    fill(*pose.mutable_pose(), *report.world_from_camera);
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) pose.add_covariance(report.tracking.covariance(row, column));
    }
  }
  pose.set_reason(report.tracking.reason);
  std::uint32_t inliers = 0;
  for (const Match& match : report.tracking.matches) inliers += match.inlier ? 1 : 0;
  pose.set_inliers(inliers);
  pose.set_age_ms(age_ms);
  return bytes_of(message);
}

std::string encode_trajectory_append(std::uint64_t first, std::span<const TrajectoryEntry> points) {
  v1::ServerMessage message;
  v1::TrajectoryAppend& append = *message.mutable_trajectory_append();
  append.set_first(first);
  for (const TrajectoryEntry& point : points) fill(*append.add_points(), point);
  return bytes_of(message);
}

std::string encode_trajectory_rewrite(std::span<const TrajectoryEntry> points, std::string_view reason) {
  v1::ServerMessage message;
  v1::TrajectoryRewrite& rewrite = *message.mutable_trajectory_rewrite();
  for (const TrajectoryEntry& point : points) fill(*rewrite.add_points(), point);
  rewrite.set_reason(std::string(reason));
  return bytes_of(message);
}

std::string encode_trajectory(std::string_view epoch, std::span<const TrajectoryEntry> points) {
  v1::Trajectory trajectory;
  trajectory.set_epoch(std::string(epoch));
  for (const TrajectoryEntry& point : points) fill(*trajectory.add_points(), point);
  return bytes_of(trajectory);
}

std::string encode_problem(std::string_view code, std::string_view detail) {
  v1::ServerMessage message;
  message.mutable_problem()->set_code(std::string(code));
  message.mutable_problem()->set_detail(std::string(detail));
  return bytes_of(message);
}

std::string encode_goodbye(std::string_view reason, double retry_after_s) {
  v1::ServerMessage message;
  message.mutable_goodbye()->set_reason(std::string(reason));
  message.mutable_goodbye()->set_retry_after_s(retry_after_s);
  return bytes_of(message);
}

std::string encode_pong(std::uint64_t nonce) {
  v1::ServerMessage message;
  message.mutable_pong()->set_nonce(nonce);
  return bytes_of(message);
}

std::string encode_layer_planes(int layer, Planes planes, std::string_view deflated,
                                std::string_view change) {
  v1::LayerPlanes message;
  message.set_layer(static_cast<std::uint32_t>(layer));
  if (planes == Planes::value) {
    message.set_value(std::string(deflated));
  } else {
    message.set_evidence(std::string(deflated));
    message.set_change(std::string(change));
  }
  return bytes_of(message);
}

std::string encode_tile(TileKey key, std::uint64_t revision, std::span<const Bytes> layers) {
  v1::Tile tile;
  fill(*tile.mutable_key(), key);
  tile.set_rev(revision);
  std::string out = bytes_of(tile);
  FieldWriter writer(out);
  for (const Bytes& layer : layers) writer.bytes(v1::Tile::kLayersFieldNumber, *layer);
  return out;
}

std::string encode_tile_batch(std::uint64_t revision, bool complete, std::span<const Bytes> tiles,
                              std::span<const TileKey> removed) {
  v1::TileBatch batch;
  batch.set_rev(revision);
  batch.set_complete(complete);
  for (const TileKey& key : removed) fill(*batch.add_removed(), key);
  const std::string head = bytes_of(batch);
  std::size_t size = head.size();
  for (const Bytes& tile : tiles) size += bytes_field_size(v1::TileBatch::kTilesFieldNumber, tile->size());
  std::string out;
  out.reserve(size + 8);
  FieldWriter writer(out);
  writer.begin(v1::ServerMessage::kTileBatchFieldNumber, size);
  writer.raw(head);
  for (const Bytes& tile : tiles) writer.bytes(v1::TileBatch::kTilesFieldNumber, *tile);
  return out;
}

}  // namespace flogmap
