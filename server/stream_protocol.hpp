// One page's side of the conversation on the stream, without its socket: what it said, what it is owed.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/outbox.hpp"
#include "server/server_state.hpp"

namespace flogmap {

/// WebSocket close code and reason.
struct StreamClose {
  std::uint16_t code = 1000;
  std::string reason;
};

inline constexpr std::uint16_t kCloseNoHello = 4000;
inline constexpr std::uint16_t kCloseUnknownVersion = 4002;
inline constexpr std::uint16_t kCloseBadFrame = 4003;
inline constexpr std::uint16_t kCloseTooSlow = 4008;

/// A page's wish for one picture stream: when the next picture is due, and of what time the last one was.
struct ImageWish {
  ImageRequest request;
  std::chrono::steady_clock::time_point next;
  std::int64_t last_ns = -1;
};

class StreamProtocol {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kHelloDeadline{5};
  static constexpr std::chrono::seconds kPingInterval{15};
  static constexpr std::chrono::seconds kDeadAfter{45};

  /// `state` must have a live map and outlive this.
  StreamProtocol(ServerState& state, Role role, Time now);

  /// Takes in one binary frame. Says if and how the connection must be closed.
  std::optional<StreamClose> receive(std::string_view frame, Time now);

  /// Looks at the deadlines; call about once a second.
  std::optional<StreamClose> check_deadlines(Time now);

  /// True once every 15 s.
  bool ping_due(Time now);
  /// Anything came from the page, a pong too.
  void heard(Time now) { heard_at_ = now; }

  /// Another map begins.
  void reset(const std::string& reason);
  /// The last message this page gets.
  Bytes goodbye(const std::string& reason);

  [[nodiscard]] Outbox& outbox() { return outbox_; }
  [[nodiscard]] std::vector<ImageWish>& image_wishes() { return image_wishes_; }
  [[nodiscard]] bool greeted() const { return greeted_; }
  [[nodiscard]] bool wants_features() const { return wants_features_; }

 private:
  std::optional<StreamClose> on(const Hello& hello, Time now);
  std::optional<StreamClose> on(const Subscribe& subscribe, Time now);
  std::optional<StreamClose> on(const Viewport& viewport, Time now);
  std::optional<StreamClose> on(const Ack& ack, Time now);
  std::optional<StreamClose> on(const Forget& forget, Time now);
  std::optional<StreamClose> on(const InspectCell& inspect, Time now);
  std::optional<StreamClose> on(const Ping& ping, Time now);
  void tell_last_pose(Time now);
  std::optional<StreamClose> send_control(std::string message);

  ServerState& state_;
  Role role_;
  Outbox outbox_;
  std::vector<ImageWish> image_wishes_;
  bool greeted_ = false;
  bool wants_features_ = false;
  Time connected_at_;
  Time heard_at_;
  Time next_ping_;
};

}  // namespace flogmap
