#pragma once

#include <string>
#include <vector>

namespace flogmap {

/// A message of the stream with every field set to something that gives itself away if it is mixed up.
struct WireSample {
  std::string name;  // "server_pose": file name without extension; starts with server_ or client_
  std::string bytes;
  bool has_tiles = false;  // holds deflated planes: another library may deflate them to other bytes
};

std::vector<WireSample> server_samples();
std::vector<WireSample> client_samples();

/// Canonical ProtoJSON of a ServerMessage or ClientMessage, as the name says; throws if the bytes are none.
std::string to_json(const WireSample& sample);

/// The planes of the sample tiles, by formula; README.md of the golden folder states the same.
std::string sample_evidence(int layer);  // E, O, K: 3 x 4096 bytes
std::string sample_change();             // 4096 bytes
std::string sample_value(int layer);     // 4096 bytes

}  // namespace flogmap
