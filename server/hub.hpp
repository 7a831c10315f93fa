// The network side: takes what the mapping says, serves it to everybody. One thread, the one that calls
// run().
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/publication.hpp"
#include "server/serve_options.hpp"
#include "server/session_control.hpp"

namespace flogmap {

/// Serves one live map (and stored ones beside it) over HTTP and WebSocket.
///
/// begin(), publish*(), rewrite_trajectory(), set_calibration() and drain() may be called from any thread and
/// return at once: they merge into a mailbox keyed by tile (the network side's one mutex) and wake the
/// network thread once, so the mapping never waits for a socket and nothing queues up. Values of one thread
/// arrive in its order; a begin() discards what was published before it.
class Hub {
 public:
  /// Binds the port. Throws std::runtime_error in one line if the options are impossible or the port is
  /// taken. `control` must outlive the hub.
  Hub(const ServeOptions& options, SessionControl& control, HubInfo info);
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  /// The bound port; differs from the option if that was 0.
  [[nodiscard]] std::uint16_t port() const;

  /// A map begins: fresh, reset or continued. Another epoch than before empties every viewer's store.
  /// Until the first begin() the server answers 503 "starting".
  void begin(MapBegin map);

  /// A stored map to be served beside the live one, as /maps/{id}. Before run() only.
  void add_stored_map(const std::string& id, MapBegin map);

  /// The tiles that the change `revision` touched, as they now are. An update without a tile (null) removes
  /// it.
  void publish(std::uint64_t revision, std::vector<TileUpdate> tiles);

  /// A mapped view that is kept for the walkthrough.
  void publish_view(SharedView view);

  /// One frame's tracking. A report with a pose is appended to the trajectory; poses are also streamed live.
  void publish_tracking(TrackingReport report);

  /// The newest pictures; costs two pointers, encoded only if somebody asks.
  void publish_pictures(PictureReport report);

  void publish_status(StatusReport report);

  /// The corrected trajectory. Entries later than the last one given stay as they are.
  void rewrite_trajectory(std::vector<TrajectoryEntry> trajectory, std::string reason);

  /// Calibration becomes known only when the source is open: replaces HubInfo::calibration_json.
  void set_calibration(std::string calibration_json);

  /// Somebody looks at pictures now (or did within the last seconds).
  [[nodiscard]] bool wants_pictures() const;

  /// SIGINT and SIGTERM call drain("shutting down"). Before run().
  void drain_on_signals();

  /// Serves, in this thread, until drained.
  void run();

  /// Shuts down: /readyz answers 503, every viewer gets Goodbye and close code 1001, then run() returns,
  /// after at most 5 s.
  void drain(std::string reason);

 private:
  class Network;
  std::unique_ptr<Network> network_;
};

}  // namespace flogmap
