// Viewers that load the server in serve_bench.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace flogmap {

/// Wall clock of this machine, the same in all its processes.
std::int64_t wall_ns();

/// `count` viewers follow poses and tiles and acknowledge them: {pose_p50_ms, pose_p99_ms, viewers_served}.
nlohmann::json watch(std::uint16_t port, int count, std::chrono::seconds duration);

/// `count` viewers that subscribe and then read nothing at all: {}.
nlohmann::json stall(std::uint16_t port, int count, std::chrono::seconds duration);

}  // namespace flogmap
