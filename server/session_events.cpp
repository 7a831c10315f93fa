#include "server/session_events.hpp"

#include <utility>

#include "server/log.hpp"

namespace flogmap {

void SessionEvents::look_at(const ServerState& state) {
  const std::string session(name_of(state.session_state()));
  if (std::exchange(session_, session) != session) {
    const bool failed = state.session_state() == SessionState::failed;
    log_event(failed ? LogLevel::error : LogLevel::info, "session",
              {{"state", session}, {"reason", state.control.reason()}});
  }
  const std::string epoch = state.live ? state.live->epoch() : std::string();
  if (std::exchange(epoch_, epoch) != epoch && state.live) {
    log_event(LogLevel::info, "a map begins",
              {{"epoch", epoch}, {"revision", static_cast<std::int64_t>(state.live->revision())}});
  }
  look_at_warnings(state.status.warnings);
}

void SessionEvents::look_at_warnings(const std::vector<std::string>& warnings) {
  const std::set<std::string> now(warnings.begin(), warnings.end());
  for (const std::string& warning : now) {
    if (!warnings_.contains(warning)) log_event(LogLevel::warning, "warning", {{"text", warning}});
  }
  for (const std::string& warning : warnings_) {
    if (!now.contains(warning)) log_event(LogLevel::info, "no longer so", {{"text", warning}});
  }
  warnings_ = now;
}

}  // namespace flogmap
