// Clients that fetch one thing over and over, and the least a server can do, for comparison.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace flogmap {

struct FetchLoad {
  std::string target;
  bool conditional = false;  // the clients know the ETag
  double per_s = 0;          // all together, evenly; 0: as fast as they are answered
  int connections = 8;
};

/// Keep-alive connections: {per_s, p50_ms, p99_ms}. They know how long the answer is and do not parse it, so
/// that the server is what is measured.
nlohmann::json fetch(std::uint16_t port, const FetchLoad& load, std::chrono::seconds duration);

/// "/api/v1/maps/live/layers/fused/tiles/0/x/y" of a tile that exists.
std::string a_tile_target(std::uint16_t port);

/// The slowest and the median answer to one normal client while 200 others send a byte at a time:
/// {slowloris_median_ms, slowloris_max_ms}.
nlohmann::json beside_slow_ones(std::uint16_t port, const std::string& target);

/// The least that Boost.Beast can do: answers every request with twelve bytes.
class BareServer {
 public:
  BareServer();
  ~BareServer();
  BareServer(const BareServer&) = delete;
  BareServer& operator=(const BareServer&) = delete;
  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flogmap
