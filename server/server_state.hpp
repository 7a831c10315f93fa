#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/metrics.hpp"
#include "server/publication.hpp"
#include "server/serve_options.hpp"
#include "server/served_map.hpp"
#include "server/session_control.hpp"

namespace flogmap {

/// Everything that is served, as the network thread knows it now. The resources in api/ read it.
struct ServerState {
  ServerState(const ServeOptions& serve_options, SessionControl& session_control, HubInfo hub_info)
      : options(serve_options), control(session_control), info(std::move(hub_info)) {}

  ServeOptions options;
  SessionControl& control;
  HubInfo info;

  std::unique_ptr<ServedMap> live;  // null until the first map begins
  std::map<std::string, std::unique_ptr<ServedMap>, std::less<>> stored;

  std::optional<TrackingReport> tracking;
  std::chrono::steady_clock::time_point tracked_at;
  PictureReport pictures;
  StatusReport status;

  std::uint32_t num_viewers = 0;
  std::size_t num_waiting_tiles = 0;   // of all viewers together, lately
  std::size_t most_waiting_tiles = 0;  // of the one that lags most
  std::size_t num_waiting_queries = 0;
  bool draining = false;
  std::chrono::steady_clock::time_point pictures_asked_at;  // over REST
  Metrics metrics;

  /// "live" or a stored map; null if there is none of this name.
  [[nodiscard]] ServedMap* find_map(std::string_view id) const {
    if (id == "live") return live.get();
    const auto found = stored.find(id);
    return found == stored.end() ? nullptr : found->second.get();
  }

  [[nodiscard]] SessionState session_state() const {
    return draining ? SessionState::draining : control.state();
  }

  [[nodiscard]] ServingStatus serving_status() const {
    if (!live) return {session_state(), 0, 0, num_viewers};
    return {session_state(), live->board().tiles().size(), live->board().map_bytes(), num_viewers};
  }
};

}  // namespace flogmap
