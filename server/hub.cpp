#include "server/hub.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <utility>

#include "server/access.hpp"
#include "server/http_app.hpp"
#include "server/listener.hpp"
#include "server/log.hpp"
#include "server/mailbox.hpp"
#include "server/picture_service.hpp"
#include "server/server_state.hpp"
#include "server/session_events.hpp"
#include "server/viewers.hpp"

namespace flogmap {

namespace net = boost::asio;
using boost::system::error_code;
using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds kDrainDeadline{5};
constexpr std::chrono::milliseconds kDrainPoll{20};
constexpr std::chrono::milliseconds kStatusInterval{500};

const ServeOptions& checked(const ServeOptions& options) {
  check(options);
  return options;
}

}  // namespace

/// All of it lives on the thread that calls run(), but for the mailbox.
class Hub::Network {
 public:
  Network(const ServeOptions& options, SessionControl& control, HubInfo info)
      : state_(checked(options), control, std::move(info)),
        access_(state_.options),
        viewers_(state_),
        app_(state_, access_, [this](std::function<void()> task) { net::post(io_, std::move(task)); }),
        pictures_(state_, viewers_, [this](std::function<void()> task) { net::post(io_, std::move(task)); }),
        limit_(options.max_connections, options.max_connections_per_address),
        listener_(io_, state_.options, {state_, app_, viewers_}, limit_),
        signals_(io_),
        drain_timer_(io_),
        status_timer_(io_) {}

  /// What the other threads hold of connections must go before the io_context, and they before the rest.
  ~Network() {
    app_.stop();
    pictures_.stop();
  }
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  void run();
  void wake(bool needed) {
    if (needed) net::post(io_, [this] { take_in(); });
  }
  void drain_on_signals();

  Mailbox mailbox_;
  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  [[nodiscard]] ServerState& state() { return state_; }
  [[nodiscard]] bool wants_pictures() const { return pictures_.wanted(); }

 private:
  void take_in();
  void begin(MapBegin map);
  void update(const Mailbox::Contents& contents);
  void take_reports(Mailbox::Contents& contents);
  void drain(const std::string& reason);
  void end_when_drained(steady_clock::time_point deadline);
  void repeat_status();

  ServerState state_;
  Access access_;
  Viewers viewers_;
  HttpApp app_;
  PictureService pictures_;
  ConnectionLimit limit_;
  net::io_context io_{1};  // after all that connections refer to: it holds them
  Listener listener_;
  net::signal_set signals_;
  net::steady_timer drain_timer_, status_timer_;
  SessionEvents events_;
};

Hub::Hub(const ServeOptions& options, SessionControl& control, HubInfo info)
    : network_(std::make_unique<Network>(options, control, std::move(info))) {}
Hub::~Hub() = default;

std::uint16_t Hub::port() const { return network_->port(); }
void Hub::begin(MapBegin map) { network_->wake(network_->mailbox_.begin(std::move(map))); }
void Hub::publish(std::uint64_t revision, std::vector<TileUpdate> tiles) {
  network_->wake(network_->mailbox_.publish(revision, std::move(tiles)));
}
void Hub::publish_view(SharedView view) { network_->wake(network_->mailbox_.publish_view(std::move(view))); }
void Hub::publish_tracking(TrackingReport report) {
  network_->wake(network_->mailbox_.publish_tracking(std::move(report)));
}
void Hub::publish_pictures(PictureReport report) {
  network_->wake(network_->mailbox_.publish_pictures(std::move(report)));
}
void Hub::publish_status(StatusReport report) {
  network_->wake(network_->mailbox_.publish_status(std::move(report)));
}
void Hub::rewrite_trajectory(std::vector<TrajectoryEntry> trajectory, std::string reason) {
  network_->wake(network_->mailbox_.rewrite_trajectory(std::move(trajectory), std::move(reason)));
}
void Hub::set_calibration(std::string calibration_json) {
  network_->wake(network_->mailbox_.set_calibration(std::move(calibration_json)));
}
void Hub::drain(std::string reason) { network_->wake(network_->mailbox_.drain(std::move(reason))); }
bool Hub::wants_pictures() const { return network_->wants_pictures(); }
void Hub::drain_on_signals() { network_->drain_on_signals(); }
void Hub::run() { network_->run(); }

void Hub::add_stored_map(const std::string& id, MapBegin map) {
  ServerState& state = network_->state();
  state.stored[id] = std::make_unique<ServedMap>(id, std::move(map), state.options.operators);
}

void Hub::Network::run() {
  listener_.start();
  repeat_status();
  io_.run();
}

void Hub::Network::drain_on_signals() {
  signals_.add(SIGINT);
  signals_.add(SIGTERM);
  signals_.async_wait([this](error_code error, int) {
    if (!error) drain("shutting down");
  });
}

void Hub::Network::take_in() {
  Mailbox::Contents contents = mailbox_.take();
  if (contents.calibration_json) state_.info.calibration_json = std::move(*contents.calibration_json);
  if (contents.begin) begin(std::move(*contents.begin));
  if (state_.live) update(contents);
  take_reports(contents);
  pictures_.offer();
  viewers_.pump_all();
  if (contents.drain_reason) drain(*contents.drain_reason);
}

void Hub::Network::begin(MapBegin map) {
  if (state_.live && state_.live->epoch() == map.epoch) {
    viewers_.map_changed(state_.live->update(map.revision, map.tiles));
    state_.live->rewrite(std::move(map.trajectory));
    viewers_.trajectory_rewritten(map.reason);
    return;
  }
  const std::string reason = map.reason;
  state_.live = std::make_unique<ServedMap>("live", std::move(map), state_.options.operators);
  state_.tracking.reset();
  viewers_.map_reset(reason);
}

void Hub::Network::update(const Mailbox::Contents& contents) {
  ServedMap& map = *state_.live;
  if (contents.revision > 0) {
    std::vector<TileUpdate> tiles;
    for (const auto& [index, tile] : contents.tiles) tiles.push_back(tile);
    viewers_.map_changed(map.update(contents.revision, tiles));
  }
  if (contents.rewrite) {
    map.rewrite(contents.rewrite->trajectory);
    viewers_.trajectory_rewritten(contents.rewrite->reason);
  }
  for (const TrajectoryEntry& entry : contents.appended) map.append(entry);
  for (const SharedView& view : contents.views) map.add(view);
}

void Hub::Network::take_reports(Mailbox::Contents& contents) {
  if (contents.pictures) state_.pictures = std::move(*contents.pictures);
  if (contents.tracking) {
    state_.tracking = std::move(contents.tracking);
    state_.tracked_at = steady_clock::now();
    viewers_.tracked();
  }
  if (contents.status) {
    state_.status = std::move(*contents.status);
    viewers_.status_changed();
  }
}

/// New connections are still taken, so that /readyz can say why it is not ready.
void Hub::Network::drain(const std::string& reason) {
  if (state_.draining) return;
  state_.draining = true;
  log_event(LogLevel::info, "shutting down",
            {{"reason", reason}, {"viewers", static_cast<std::int64_t>(viewers_.size())}});
  viewers_.dismiss_all(reason);
  end_when_drained(steady_clock::now() + kDrainDeadline);
}

void Hub::Network::end_when_drained(steady_clock::time_point deadline) {
  if (viewers_.size() == 0 || steady_clock::now() >= deadline) return io_.stop();
  drain_timer_.expires_after(kDrainPoll);
  drain_timer_.async_wait([this, deadline](error_code error) {
    if (!error) end_when_drained(deadline);
  });
}

/// The session may change without a report of the mapping: pages hear of it all the same.
void Hub::Network::repeat_status() {
  events_.look_at(state_);
  viewers_.status_changed();
  pictures_.offer();
  viewers_.pump_all();
  status_timer_.expires_after(kStatusInterval);
  status_timer_.async_wait([this](error_code error) {
    if (!error) repeat_status();
  });
}

}  // namespace flogmap
