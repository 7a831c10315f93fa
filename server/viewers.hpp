#pragma once

#include <chrono>
#include <set>
#include <span>
#include <string>

#include "server/picture_key.hpp"
#include "server/stream_protocol.hpp"

namespace flogmap {

/// One connected page, as the hub sees it.
class Viewer {
 public:
  virtual ~Viewer() = default;
  virtual StreamProtocol& protocol() = 0;
  /// Sends what may be sent; called whenever something may have changed.
  virtual void pump() = 0;
  /// Says goodbye and closes with 1001.
  virtual void dismiss(const std::string& reason) = 0;
};

/// All pages. Everything is said once and its bytes are shared.
class Viewers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Viewers(ServerState& state) : state_(state) {}

  void join(Viewer& viewer);
  void leave(Viewer& viewer);

  void map_changed(std::span<const Slot> slots);
  void map_reset(const std::string& reason);
  void trajectory_rewritten(const std::string& reason);
  void tracked();         // state.tracking is new
  void status_changed();  // state.status or the session is
  void playback_changed();
  void dismiss_all(const std::string& reason);
  void pump_all();

  /// Sizes in which somebody wants the picture of this time now, and could take it.
  [[nodiscard]] std::set<PictureKey> wanted_pictures(std::int64_t timestamp_ns, Time now);
  /// Somebody has asked for pictures at all.
  [[nodiscard]] bool any_picture_wish();
  void deliver_picture(PictureKey key, std::int64_t timestamp_ns, const Bytes& message, Time now);

  [[nodiscard]] std::size_t size() const { return viewers_.size(); }

 private:
  void count_waiting();

  ServerState& state_;
  std::set<Viewer*> viewers_;
};

}  // namespace flogmap
