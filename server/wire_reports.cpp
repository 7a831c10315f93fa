// Reports of the mapping as server messages.
#include <algorithm>
#include <utility>
#include <vector>

#include "server/wire_values.hpp"

namespace flogmap {
namespace {

v1::ImageStream to_proto(ImageStream stream) {
  switch (stream) {
    case ImageStream::left:
      return v1::IMAGE_STREAM_LEFT;
    case ImageStream::right:
      return v1::IMAGE_STREAM_RIGHT;
    case ImageStream::disparity:
      return v1::IMAGE_STREAM_DISPARITY;
  }
  return v1::IMAGE_STREAM_UNSPECIFIED;
}

using Corner = std::pair<float, float>;

std::vector<Corner> unmatched_corners(const Tracking& tracking) {
  std::vector<Corner> matched;
  for (const Match& match : tracking.matches)
    matched.emplace_back(match.current_px.x(), match.current_px.y());
  std::sort(matched.begin(), matched.end());
  std::vector<Corner> unmatched;
  for (const Eigen::Vector2f& corner_px : tracking.corners_px) {
    const Corner corner(corner_px.x(), corner_px.y());
    if (!std::binary_search(matched.begin(), matched.end(), corner)) unmatched.push_back(corner);
  }
  return unmatched;
}

}  // namespace

std::string encode_features(const TrackingReport& report) {
  v1::ServerMessage message;
  v1::Features& features = *message.mutable_features();
  features.set_time_ns(report.timestamp_ns);
  for (const Match& match : report.tracking.matches) {
    features.add_current_px(match.current_px.x());
    features.add_current_px(match.current_px.y());
    features.add_key_px(match.key_px.x());
    features.add_key_px(match.key_px.y());
    features.add_inlier(match.inlier);
  }
  for (const auto& [x, y] : unmatched_corners(report.tracking)) {
    features.add_unmatched_px(x);
    features.add_unmatched_px(y);
  }
  return message.SerializeAsString();
}

std::string encode_image(const EncodedPicture& picture) {
  v1::ServerMessage message;
  v1::ImageFrame& image = *message.mutable_image_frame();
  image.set_stream(to_proto(picture.stream));
  image.set_time_ns(picture.timestamp_ns);
  image.set_media_type(picture.media_type);
  image.set_data(picture.data);
  image.set_scale_min(picture.scale_min_px);
  image.set_scale_max(picture.scale_max_px);
  image.set_width(static_cast<std::uint32_t>(picture.width_px));
  image.set_height(static_cast<std::uint32_t>(picture.height_px));
  image.set_full_width(static_cast<std::uint32_t>(picture.full_width_px));
  image.set_full_height(static_cast<std::uint32_t>(picture.full_height_px));
  return message.SerializeAsString();
}

std::string encode_status(const StatusReport& report, const ServingStatus& serving) {
  v1::ServerMessage message;
  v1::Status& status = *message.mutable_status();
  status.set_session_state(std::string(name_of(serving.state)));
  status.set_frames_per_s(report.frames_per_s);
  status.set_frames(report.frames);
  status.set_tracked(report.tracked);
  status.set_lost(report.lost);
  status.set_mapped_views(report.mapped_views);
  status.set_loops(report.loops);
  status.set_dropped_frames(report.dropped_frames);
  status.set_skipped_frames(report.skipped_frames);
  status.set_tiles(serving.tiles);
  status.set_map_bytes(serving.map_bytes);
  for (const StageReport& stage : report.stages) {
    v1::StageTime& time = *status.add_stages();
    time.set_stage(stage.stage);
    time.set_median_ms(stage.median_ms);
    time.set_p95_ms(stage.p95_ms);
  }
  for (const std::string& warning : report.warnings) status.add_warnings(warning);
  status.set_viewers(serving.viewers);
  status.set_alignment(report.alignment);
  if (report.processor_celsius) status.set_processor_celsius(*report.processor_celsius);
  if (report.skew && report.skew->histogram.total() > 0) {
    v1::PairSkew& skew = *status.mutable_pair_skew();
    skew.set_mean_ms(report.skew->histogram.mean_ms());
    skew.set_largest_ms(report.skew->histogram.largest_ms);
    skew.set_allowed_ms(report.skew->allowed_ms);
    skew.set_dropped_pairs(static_cast<std::uint64_t>(report.skew->num_dropped));
  }
  return message.SerializeAsString();
}

std::string encode_playback(const PlaybackState& playback) {
  v1::ServerMessage message;
  v1::Playback& to = *message.mutable_playback();
  to.set_seekable(playback.seekable);
  to.set_position_s(playback.position_s);
  to.set_duration_s(playback.duration_s);
  to.set_rate(playback.rate);
  to.set_paused(playback.paused);
  to.set_loop(playback.loop);
  return message.SerializeAsString();
}

std::string encode_cell_column(const CellColumn& column) {
  v1::ServerMessage message;
  v1::CellColumn& to = *message.mutable_cell_column();
  to.set_x(column.x_m);
  to.set_y(column.y_m);
  to.set_epoch(column.epoch);
  to.set_rev(column.revision);
  for (const CellEvidence& cell : column.layers) {
    v1::CellEvidence& evidence = *to.add_layers();
    evidence.set_layer(static_cast<std::uint32_t>(cell.layer));
    evidence.set_empty(cell.empty);
    evidence.set_occupied(cell.occupied);
    evidence.set_confidence(cell.confidence);
    evidence.set_rays(cell.rays);
    evidence.set_value(cell.value);
    evidence.set_planning(cell.planning);
    evidence.set_motion(cell.motion);
    evidence.set_conflict(cell.conflict);
    evidence.set_change(cell.change);
  }
  return message.SerializeAsString();
}

}  // namespace flogmap
