#include "server/stream_protocol.hpp"

#include <algorithm>
#include <utility>

#include "server/access.hpp"
#include "server/cell_inspection.hpp"

namespace flogmap {
namespace {

StreamClose bad_frame(std::string reason) { return {kCloseBadFrame, std::move(reason)}; }

constexpr std::chrono::seconds kRests{1};  // a camera without a new pose for so long; else one comes at once

/// Why a page of this map must begin anew; null if it may go on from what it has. After a kill it may hold
/// tiles and poses that were never stored. A continued map begins above all revisions that could have been
/// sent (server/commands/continued_map.cpp), where the store could tell; where it could not, they are above
/// the map's.
const char* why_begin_anew(const Resume& known, const ServedMap& map) {
  if (known.revision > map.revision()) return "what you have seen was never stored";
  const bool all_newer = known.revision > 0 && known.revision < map.board().oldest_revision().value_or(0);
  return all_newer ? "every tile has changed" : nullptr;
}

}  // namespace

StreamProtocol::StreamProtocol(ServerState& state, Role role, Time now)
    : state_(state), role_(role), connected_at_(now), heard_at_(now), next_ping_(now + kPingInterval) {}

std::optional<StreamClose> StreamProtocol::receive(std::string_view frame, Time now) {
  heard(now);
  state_.metrics.count_received(frame.size());
  const auto message = decode_client_message(frame);
  if (!message) return bad_frame("not a ClientMessage");
  if (greeted_ == std::holds_alternative<Hello>(*message)) {
    return bad_frame(greeted_ ? "Hello comes once" : "Hello comes first");
  }
  return std::visit([&](const auto& what) { return on(what, now); }, *message);
}

std::optional<StreamClose> StreamProtocol::on(const Hello& hello, Time) {
  if (std::find(hello.versions.begin(), hello.versions.end(), kProtocolVersion) == hello.versions.end()) {
    return StreamClose{kCloseUnknownVersion, "this server speaks version 1"};
  }
  greeted_ = true;
  ServedMap& map = *state_.live;
  const MapHeader header = map.header();
  send_control(encode_welcome(header, {}, name_of(role_), state_.info.version));
  if (hello.resume && !hello.resume->epoch.empty()) {
    const bool same_map = hello.resume->epoch == map.epoch();
    if (const char* why = same_map ? why_begin_anew(*hello.resume, map) : "another map") {
      send_control(encode_reset(header, why));
    } else {
      outbox_.resume(*hello.resume, map);
    }
  }
  outbox_.status(to_shared(encode_status(state_.status, state_.serving_status())));
  outbox_.playback(to_shared(encode_playback(state_.control.playback())));
  return std::nullopt;
}

std::optional<StreamClose> StreamProtocol::on(const Subscribe& subscribe, Time now) {
  image_wishes_.clear();
  for (const ImageRequest& request : subscribe.images) {
    if (request.max_fps > 0) image_wishes_.push_back({request, now, -1});
  }
  wants_features_ = subscribe.features;
  outbox_.subscribe(subscribe, *state_.live);
  if (outbox_.wants_pose() && state_.tracking && now - state_.tracked_at >= kRests) tell_last_pose(now);
  return std::nullopt;
}

/// Where the camera is, to one who comes while it rests: paused, or at the end of a recording.
void StreamProtocol::tell_last_pose(Time now) {
  const std::chrono::duration<double, std::milli> since = now - state_.tracked_at;
  outbox_.pose(to_shared(encode_pose(*state_.tracking, state_.tracking->latency_ms + since.count())));
}

std::optional<StreamClose> StreamProtocol::on(const Viewport& viewport, Time) {
  outbox_.look_at(viewport, *state_.live);
  return std::nullopt;
}

std::optional<StreamClose> StreamProtocol::on(const Ack& ack, Time now) {
  if (outbox_.acknowledge(ack.bytes, now)) return std::nullopt;
  return bad_frame("acknowledged more bytes than were sent");
}

std::optional<StreamClose> StreamProtocol::on(const Forget& forget, Time) {
  outbox_.forget(forget.keys, *state_.live);
  return std::nullopt;
}

std::optional<StreamClose> StreamProtocol::on(const InspectCell& inspect, Time) {
  if (!has_cell(state_.live->board().info().grid, inspect.x_m, inspect.y_m)) {
    return send_control(encode_problem("out-of-range", "no cell lies so far out"));
  }
  return send_control(encode_cell_column(inspect_cell(*state_.live, inspect.x_m, inspect.y_m)));
}

std::optional<StreamClose> StreamProtocol::on(const Ping& ping, Time) {
  return send_control(encode_pong(ping.nonce));
}

std::optional<StreamClose> StreamProtocol::send_control(std::string message) {
  if (outbox_.control(to_shared(std::move(message)))) return std::nullopt;
  return StreamClose{kCloseTooSlow, "answers are not read"};
}

std::optional<StreamClose> StreamProtocol::check_deadlines(Time now) {
  if (!greeted_ && now - connected_at_ >= kHelloDeadline)
    return StreamClose{kCloseNoHello, "no Hello within 5 s"};
  if (outbox_.overdue(now)) return StreamClose{kCloseTooSlow, "nothing acknowledged for 30 s"};
  if (now - heard_at_ >= kDeadAfter) return StreamClose{kCloseTooSlow, "not heard of for 45 s"};
  return std::nullopt;
}

bool StreamProtocol::ping_due(Time now) {
  if (now < next_ping_) return false;
  next_ping_ = now + kPingInterval;
  return true;
}

void StreamProtocol::reset(const std::string& reason) {
  if (!greeted_) return;
  send_control(encode_reset(state_.live->header(), reason));
  outbox_.reset(*state_.live);
}

Bytes StreamProtocol::goodbye(const std::string& reason) {
  Bytes message = to_shared(encode_goodbye(reason, 2));
  outbox_.control(message);
  return message;
}

}  // namespace flogmap
