#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "tests/server/client_frames.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/synthetic_walk.hpp"
#include "tests/server/tile_mirror.hpp"

namespace flogmap {

inline const Subscribe kEvidence{{{}, Planes::evidence}, {}, 20, false};

/// A hub, and the same map kept here to compare with.
class StreamTest : public ::testing::Test {
 protected:
  void begin(const std::string& epoch = "0000000000000001") {
    walk_ = SyntheticWalk(7);
    truth_ = std::make_unique<ServedMap>("live", walk_.begin(epoch, "started"), Operators::algebraic);
    server_.hub().begin(walk_.begin(epoch, "started"));
    settle();
  }

  void step(int count) {
    for (; count > 0; --count) {
      auto tiles = walk_.step();
      if (!tiles.empty()) truth_->update(walk_.revision(), tiles);
      if (!tiles.empty()) server_.hub().publish(walk_.revision(), tiles);
      const TrackingReport report = walk_.tracking();
      truth_->append({report.timestamp_ns, *report.world_from_camera, report.tracking.state, report.mapped});
      server_.hub().publish_tracking(report);
    }
    settle();
  }

  /// Until what was published has been taken in.
  void settle() {
    for (int i = 0; i < 200; ++i) {
      const HttpReply reply = http(server_.port(), "GET", "/api/v1/maps/live");
      const bool there = reply.body.find(truth_->epoch()) != std::string::npos;
      if (there &&
          reply.body.find("\"rev\":" + std::to_string(truth_->revision()) + ",") != std::string::npos)
        return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL() << "the hub does not take in what is published";
  }

  /// Reads and acknowledges until the mirror holds what the map holds.
  void follow(StreamClient& client, TileMirror& mirror) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (difference(mirror, *truth_, kEvidence.tiles) != "" &&
           std::chrono::steady_clock::now() < deadline) {
      const auto message = client.read(std::chrono::seconds(1));
      if (!message) continue;
      mirror.take(*message);
      client.send(ack_frame(mirror.batch_bytes()));
    }
    EXPECT_EQ(difference(mirror, *truth_, kEvidence.tiles), "");
  }

  void greet(StreamClient& client) {
    client.send(hello_frame());
    client.send(subscribe_frame(kEvidence));
  }

  LoopbackHub server_;
  SyntheticWalk walk_;
  std::unique_ptr<ServedMap> truth_;
};

}  // namespace flogmap
