#include "server/store/map_rows.hpp"

#include "server/store/checksum.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kPoseBytes = 96;

}  // namespace

std::vector<std::uint8_t> pose_bytes(const SE3& pose) {
  LittleEndianBytes bytes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) bytes.add(pose(row, column));
  }
  return bytes.take();
}

std::optional<SE3> pose_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kPoseBytes) return std::nullopt;
  SE3 pose = SE3::Identity();
  for (int i = 0; i < 12; ++i) {
    pose(i / 4, i % 4) = little_endian_double(bytes, static_cast<std::size_t>(i) * 8);
  }
  if (!pose.matrix().allFinite()) return std::nullopt;
  return pose;
}

std::uint64_t tile_checksum(TileIndex index, std::uint64_t revision, std::span<const std::uint8_t> cells) {
  LittleEndianBytes key;
  key.add_signed(index.x).add_signed(index.y).add(revision);
  return Sha256().add(key.bytes()).add(cells).number();
}

std::uint64_t pose_checksum(std::uint64_t number, const TrajectoryEntry& entry) {
  LittleEndianBytes key;
  key.add(number).add_signed(entry.timestamp_ns);
  key.add(std::uint64_t{static_cast<std::uint8_t>(entry.state)}).add(std::uint64_t{entry.mapped});
  return Sha256().add(key.bytes()).add(pose_bytes(entry.world_from_camera)).number();
}

std::uint64_t view_checksum(const StoredView& view) {
  LittleEndianBytes key;
  key.add_signed(view.number).add_signed(view.timestamp_ns).add_signed(view.codec);
  return Sha256().add(key.bytes()).add(pose_bytes(view.world_from_camera)).add(view.bytes).number();
}

}  // namespace flogmap
