// What loads the server in serve_bench: viewers, and clients that fetch one thing over and over.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace flogmap {

/// Wall clock of this machine, the same in all its processes.
std::int64_t wall_ns();

/// `count` viewers follow poses and tiles and acknowledge them: {pose_p50_ms, pose_p99_ms, viewers_served}.
nlohmann::json watch(std::uint16_t port, int count, std::chrono::seconds duration);

/// Eight keep-alive connections fetch `target` as fast as they can; with `conditional` they know its ETag:
/// {per_s}.
nlohmann::json fetch(std::uint16_t port, const std::string& target, bool conditional,
                     std::chrono::seconds duration);

/// "/api/v1/maps/live/layers/fused/tiles/0/x/y" of a tile that exists.
std::string a_tile_target(std::uint16_t port);

/// The least that Boost.Beast can do: answers every request with twelve bytes. For comparison.
class BareServer {
 public:
  BareServer();
  ~BareServer();
  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flogmap
