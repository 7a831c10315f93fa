#pragma once

#include <set>
#include <string>

#include "server/server_state.hpp"

namespace flogmap {

/// Writes into the log what changes about the session: its state, its map, its warnings. Looks now and then.
class SessionEvents {
 public:
  void look_at(const ServerState& state);

 private:
  void look_at_warnings(const std::vector<std::string>& warnings);

  std::string session_;
  std::string epoch_;
  std::set<std::string> warnings_;
};

}  // namespace flogmap
