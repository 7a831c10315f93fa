// Our values to the bytes of proto/flogmap/v1 and back. Protobuf stops in the .cpp files of this name.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/view.hpp"
#include "server/cell_column.hpp"
#include "server/client_message.hpp"
#include "server/map_header.hpp"
#include "server/publication.hpp"
#include "server/session_control.hpp"

namespace flogmap {

/// Immutable bytes that many clients share.
using Bytes = std::shared_ptr<const std::string>;

inline Bytes to_shared(std::string bytes) { return std::make_shared<const std::string>(std::move(bytes)); }

struct WireLimits {
  std::uint32_t max_unacknowledged_bytes = 1U << 20U;
  std::uint32_t max_batch_bytes = 256U << 10U;
  std::uint32_t max_client_frame_bytes = 64U << 10U;
};

/// An encoded picture, ready to be sent.
struct EncodedPicture {
  ImageStream stream = ImageStream::left;
  std::int64_t timestamp_ns = 0;
  std::string media_type;  // "image/jpeg" or "image/png"
  std::string data;
  double scale_min_px = 0;  // disparity: ends of the colour scale
  double scale_max_px = 0;
  int width_px = 0;
  int height_px = 0;
  int full_width_px = 0;
  int full_height_px = 0;
};

/// What a StatusReport does not know.
struct ServingStatus {
  SessionState state = SessionState::starting;
  std::uint64_t tiles = 0;
  std::uint64_t map_bytes = 0;
  std::uint32_t viewers = 0;
};

/// Names as the wire and REST use them: "running", "ok", "view".
std::string_view name_of(SessionState state);
std::string_view name_of(TrackingState state);

// Each of these is one ServerMessage.
std::string encode_welcome(const MapHeader& map, const WireLimits& limits, std::string_view role,
                           std::string_view server_version);
std::string encode_snapshot_begin(std::uint64_t tiles, std::uint64_t bytes);
std::string encode_snapshot_end(std::uint64_t revision);
std::string encode_reset(const MapHeader& map, std::string_view reason);
std::string encode_pose(const TrackingReport& report, double age_ms);
std::string encode_features(const TrackingReport& report);
std::string encode_trajectory_append(std::uint64_t first, std::span<const TrajectoryEntry> points);
std::string encode_trajectory_rewrite(std::span<const TrajectoryEntry> points, std::string_view reason);
std::string encode_image(const EncodedPicture& picture);
std::string encode_status(const StatusReport& report, const ServingStatus& serving);
std::string encode_playback(const PlaybackState& playback);
std::string encode_cell_column(const CellColumn& column);
std::string encode_problem(std::string_view code, std::string_view detail);
std::string encode_goodbye(std::string_view reason, double retry_after_s);
std::string encode_pong(std::uint64_t nonce);

/// The message LayerPlanes; `change` may be empty. Both are deflated already.
std::string encode_layer_planes(int layer, Planes planes, std::string_view deflated, std::string_view change);

/// The message Tile, out of layers that encode_layer_planes() made.
std::string encode_tile(TileKey key, std::uint64_t revision, std::span<const Bytes> layers);

/// One ServerMessage with a TileBatch, out of tiles that encode_tile() made.
std::string encode_tile_batch(std::uint64_t revision, bool complete, std::span<const Bytes> tiles,
                              std::span<const TileKey> removed);

/// The message Trajectory, for REST.
std::string encode_trajectory(std::string_view epoch, std::span<const TrajectoryEntry> points);

}  // namespace flogmap
