// Our values into generated messages. For the wire*.cpp files alone: the only header that sees Protobuf.
#pragma once

#include "flogmap/v1/stream.pb.h"
#include "server/wire.hpp"

namespace flogmap {

v1::TrackingState to_proto(TrackingState state);
void fill(v1::TileKey& to, TileKey from);
void fill(v1::PoseValue& to, const SE3& world_from_camera);
void fill(v1::TrajectoryPoint& to, const TrajectoryEntry& from);
void fill(v1::CameraModel& to, const StereoCamera& from);
void fill(v1::MapInfo& to, const MapHeader& from);

}  // namespace flogmap
