// Deadlines and orders of the stream, with the time told.
#include "server/stream_protocol.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "server/mailbox.hpp"
#include "tests/server/client_frames.hpp"
#include "tests/server/fake_session.hpp"
#include "tests/server/synthetic_walk.hpp"
#include "tests/server/tile_mirror.hpp"

namespace flogmap {
namespace {

using namespace std::chrono_literals;

class ProtocolTest : public ::testing::Test {
 protected:
  ProtocolTest() : state_({}, session_, {}) {
    state_.live =
        std::make_unique<ServedMap>("live", walk_.begin("0000000000000001", "started"), Operators::algebraic);
    for (int i = 0; i < 60; ++i) {
      const auto tiles = walk_.step();
      state_.live->update(walk_.revision(), tiles);
    }
  }

  int code(const std::optional<StreamClose>& close) { return close ? close->code : 0; }
  Bytes next(StreamProtocol& protocol, StreamProtocol::Time now) {
    return protocol.outbox().next(*state_.live, now);
  }

  const StreamProtocol::Time start_{1h};
  FakeSession session_;
  SyntheticWalk walk_;
  ServerState state_;
};

TEST_F(ProtocolTest, HelloIsDueInFiveSeconds) {
  StreamProtocol silent(state_, Role::view, start_), polite(state_, Role::view, start_);
  polite.receive(hello_frame(), start_ + 4s);
  EXPECT_EQ(code(silent.check_deadlines(start_ + 4s)), 0);
  EXPECT_EQ(code(silent.check_deadlines(start_ + 5s)), 4000);
  EXPECT_EQ(code(polite.check_deadlines(start_ + 5s)), 0);
}

TEST_F(ProtocolTest, WithoutAnAckForThirtySecondsItIsClosed) {
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  protocol.receive(subscribe_frame({{{}, Planes::evidence}, {}, 0, false}), start_);
  while (next(protocol, start_)) {
  }
  ASSERT_GT(protocol.outbox().unacknowledged(), 0U);
  protocol.receive(ping_frame(1), start_ + 29s);  // alive, but acknowledges nothing
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 29s)), 0);
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 30s)), 4008);
  protocol.receive(ack_frame(protocol.outbox().unacknowledged()), start_ + 29s);
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 60s)), 0);
}

TEST_F(ProtocolTest, PingsEveryFifteenSecondsAndDeadAfterFortyFive) {
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  EXPECT_FALSE(protocol.ping_due(start_ + 14s));
  EXPECT_TRUE(protocol.ping_due(start_ + 15s));
  EXPECT_FALSE(protocol.ping_due(start_ + 29s));
  EXPECT_TRUE(protocol.ping_due(start_ + 30s));
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 44s)), 0);
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 45s)), 4008);
  protocol.heard(start_ + 30s);
  EXPECT_EQ(code(protocol.check_deadlines(start_ + 45s)), 0);
}

TEST_F(ProtocolTest, OneWhoAsksButDoesNotReadIsClosed) {
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  int closed = 0, asked = 0;
  for (; asked < 1000 && closed == 0; ++asked) closed = code(protocol.receive(ping_frame(1), start_));
  EXPECT_EQ(closed, 4008);
  EXPECT_LE(asked, static_cast<int>(Outbox::kMaxControls));
}

TEST_F(ProtocolTest, APoseNeverWaitsBehindMoreThanOneBatch) {
  Outbox outbox(WireLimits{1U << 20U, 1, 65536});  // one tile a batch: a long snapshot
  outbox.subscribe({{{}, Planes::evidence}, {}, 20, false}, *state_.live);
  TileMirror mirror;
  while (mirror.tiles().size() < 2) mirror.take(*outbox.next(*state_.live, start_));
  ASSERT_GT(outbox.num_pending(), 0U);
  const Bytes pose = to_shared(encode_pose(walk_.tracking(), 0));
  outbox.image(ImageStream::left, to_shared("a picture"));
  outbox.pose(pose);
  EXPECT_EQ(outbox.next(*state_.live, start_ + 1ms), pose);
}

TEST_F(ProtocolTest, APictureWaitsForTheTilesOfOneRoundThoughTilesNeverEnd) {
  Outbox outbox(WireLimits{1U << 20U, 1, 65536});  // one tile a batch
  outbox.subscribe({{{}, Planes::evidence}, {}, 0, false}, *state_.live);
  const Bytes picture = to_shared("a picture");
  const int num_slots = static_cast<int>(state_.live->board().num_slots());
  std::vector<Slot> all(num_slots);
  std::iota(all.begin(), all.end(), Slot{0});
  auto now = start_;
  std::uint64_t taken_in = 0;
  for (int turn = 0; turn < 3; ++turn) {
    outbox.image(ImageStream::left, picture);
    int num_before = 0;
    for (; outbox.next(*state_.live, now += 50ms) != picture; ++num_before) {
      ASSERT_LE(num_before, 3 * num_slots);
      ASSERT_TRUE(outbox.acknowledge(taken_in += outbox.unacknowledged(), now));
      outbox.changed(all);
    }
    EXPECT_GE(num_before, num_slots) << "tiles go before pictures";
  }
}

TEST_F(ProtocolTest, ChangesComeAtNoMoreThanTenHertz) {
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  protocol.receive(subscribe_frame({{{}, Planes::value}, {}, 0, false}), start_);
  TileMirror mirror;
  int num_batches = 0;
  const auto drain = [&](StreamProtocol::Time now) {
    while (const Bytes message = next(protocol, now)) {
      num_batches += mirror.take(*message) == TileMirror::Effect::tiles ? 1 : 0;
      protocol.receive(ack_frame(mirror.batch_bytes()), now);
    }
  };
  drain(start_);
  num_batches = 0;
  for (int ms = 0; ms < 2000; ms += 10) {
    auto tiles = walk_.step();
    if (!tiles.empty()) protocol.outbox().changed(state_.live->update(walk_.revision(), tiles));
    drain(start_ + std::chrono::milliseconds(ms));
  }
  EXPECT_LE(num_batches, 20);
  EXPECT_GE(num_batches, 15);
}

TEST_F(ProtocolTest, AnyRateOfPosesMayBeAskedForAndTheNextOneCountsAtOnce) {
  Outbox outbox;
  const auto ask = [&](double pose_hz) { outbox.subscribe({{}, {}, pose_hz, false}, *state_.live); };
  const auto sends_pose = [&](StreamProtocol::Time now) {
    outbox.pose(to_shared("pose"));
    const Bytes message = outbox.next(*state_.live, now);
    return message && *message == "pose";
  };
  ask(1);
  while (outbox.next(*state_.live, start_)) outbox.acknowledge(0, start_);
  for (const double seldom : {5e-324, 1e-80, 0.001}) {
    ask(seldom);
    EXPECT_TRUE(sends_pose(start_));
    EXPECT_FALSE(sends_pose(start_ + std::chrono::minutes(10)));
  }
  ask(20);
  EXPECT_TRUE(sends_pose(start_));
  EXPECT_TRUE(sends_pose(start_ + std::chrono::milliseconds(50)));
}

TEST_F(ProtocolTest, OneWhoComesWhileTheCameraRestsIsToldWhereItIs) {
  state_.tracking = walk_.tracking();
  state_.tracked_at = start_ - 2s;
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  protocol.receive(subscribe_frame({{}, {}, 20, false}), start_);
  const std::string pose = encode_pose(*state_.tracking, state_.tracking->latency_ms + 2000);
  int told = 0;
  while (const Bytes message = next(protocol, start_)) told += *message == pose ? 1 : 0;
  EXPECT_EQ(told, 1);
}

TEST_F(ProtocolTest, VisibleTilesComeFirst) {
  StreamProtocol protocol(state_, Role::view, start_);
  protocol.receive(hello_frame(), start_);
  const TileBoard& board = state_.live->board();
  const Bounds view = tile_bounds(board.info().grid, {0, 2, 1});
  Outbox outbox(WireLimits{1U << 20U, 1, 65536});  // one tile a batch
  outbox.look_at({view, 0}, *state_.live);
  outbox.subscribe({{{}, Planes::value}, {}, 0, false}, *state_.live);
  TileMirror mirror;
  while (mirror.tiles().empty()) mirror.take(*outbox.next(*state_.live, start_));
  EXPECT_TRUE(intersect(tile_bounds(board.info().grid, mirror.tiles().begin()->first), view));
  EXPECT_EQ(mirror.tiles().begin()->first.level, 0U);
}

// A viewer saw more than the store kept, then the program was killed: the continued map begins far above,
// with every tile at the new revision, and without the tile that was lost.
TEST_F(ProtocolTest, AfterAKillAViewerKeepsNothingThatWasNeverStored) {
  MapBegin continued = walk_.begin("0000000000000001", "continued");
  continued.revision = walk_.revision() + 1'000'000;
  const auto& tiles = state_.live->board().tiles();
  for (const auto& [index, tile] : tiles) {
    continued.tiles.push_back(
        {index, continued.revision, std::make_shared<const Tile>(Tile{tile->cells, continued.revision})});
  }
  TileMirror viewer;
  const auto talk = [&](const Resume& known) {
    StreamProtocol protocol(state_, Role::view, start_);
    viewer.reconnect();
    protocol.receive(hello_frame(known), start_);
    protocol.receive(subscribe_frame({{{}, Planes::evidence}, {}, 0, false}), start_);
    while (const Bytes bytes = next(protocol, start_)) {
      viewer.take(*bytes);
      protocol.receive(ack_frame(viewer.batch_bytes()), start_);
    }
  };
  talk({});
  ASSERT_EQ(difference(viewer, *state_.live, {{}, Planes::evidence}), "");
  const std::uint64_t known_revision = viewer.complete_revision();
  continued.tiles.pop_back();
  state_.live = std::make_unique<ServedMap>("live", std::move(continued), Operators::algebraic);
  talk({"0000000000000001", known_revision, 0});
  EXPECT_EQ(difference(viewer, *state_.live, {{}, Planes::evidence}), "");
}

// The disk took nothing from the start until a kill: what goes on is the map of before, at its old revision.
TEST_F(ProtocolTest, AViewerThatKnowsARevisionThatNeverWasBeginsAnew) {
  const MapBegin earlier = SyntheticWalk().begin("0000000000000001", "continued");
  StreamProtocol protocol(state_, Role::view, start_);
  const std::uint64_t seen = walk_.revision();
  ASSERT_GT(seen, earlier.revision);
  state_.live = std::make_unique<ServedMap>("live", earlier, Operators::algebraic);
  protocol.receive(hello_frame(Resume{"0000000000000001", seen, 5}), start_);
  TileMirror viewer;
  bool reset = false;
  while (const Bytes message = next(protocol, start_))
    reset = viewer.take(*message) == TileMirror::Effect::reset || reset;
  EXPECT_TRUE(reset);
}

TEST_F(ProtocolTest, PicturesCountToTheMebibyteThatMayBeUnacknowledged) {
  Outbox outbox;
  outbox.subscribe({{{}, Planes::value}, {}, 0, false}, *state_.live);
  std::uint64_t taken_in = 0;
  const auto answer = [&] { return outbox.acknowledge(taken_in += outbox.unacknowledged(), start_); };
  while (outbox.next(*state_.live, start_)) ASSERT_TRUE(answer());
  for (int quick = 0; quick < 5; ++quick) {  // until as much as ever may be on the way
    outbox.image(ImageStream::left, to_shared(std::string(900U << 10U, 'x')));
    while (outbox.next(*state_.live, start_)) ASSERT_TRUE(answer());
  }
  for (const std::size_t kib : {300, 300, 300, 300, 2000, 300}) {
    outbox.image(ImageStream::left, to_shared(std::string(kib << 10U, 'x')));
    while (outbox.next(*state_.live, start_)) {
    }
    EXPECT_LE(outbox.unacknowledged(), WireLimits{}.max_unacknowledged_bytes);
  }
  const std::uint64_t sent = 900U << 10U;
  EXPECT_EQ(outbox.unacknowledged(), sent);
}

TEST(Mailbox, KeepsTheNewestOfEachTileAndWakesOnce) {
  Mailbox mailbox;
  const auto tile = std::make_shared<const Tile>();
  EXPECT_TRUE(mailbox.publish(3, {{{0, 0}, 3, tile}, {{1, 0}, 3, tile}}));
  EXPECT_FALSE(mailbox.publish(4, {{{0, 0}, 4, tile}}));
  EXPECT_FALSE(mailbox.publish(2, {{{1, 0}, 2, nullptr}}));  // late: ignored
  const Mailbox::Contents contents = mailbox.take();
  EXPECT_EQ(contents.revision, 4U);
  ASSERT_EQ(contents.tiles.size(), 2U);
  EXPECT_EQ(contents.tiles.at({0, 0}).revision, 4U);
  EXPECT_EQ(contents.tiles.at({1, 0}).revision, 3U);
  EXPECT_TRUE(mailbox.take().tiles.empty());
  EXPECT_TRUE(mailbox.publish(5, {}));
}

TEST(Mailbox, ANewMapDiscardsWhatWasSaidOfTheOld) {
  Mailbox mailbox;
  SyntheticWalk walk;
  walk.step();
  mailbox.publish(9, {{{0, 0}, 9, std::make_shared<const Tile>()}});
  mailbox.publish_tracking(walk.tracking());
  mailbox.begin(walk.begin("2", "reset"));
  mailbox.publish_tracking(walk.tracking());
  const Mailbox::Contents contents = mailbox.take();
  EXPECT_TRUE(contents.begin);
  EXPECT_TRUE(contents.tiles.empty());
  EXPECT_EQ(contents.appended.size(), 1U);
}

TEST(Mailbox, ARewrittenPathKeepsWhatCameAfterIt) {
  Mailbox mailbox;
  SyntheticWalk walk;
  std::vector<TrajectoryEntry> path;
  for (int i = 0; i < 4; ++i) {
    walk.step();
    const TrackingReport report = walk.tracking();
    mailbox.publish_tracking(report);
    if (i < 3) path.push_back({report.timestamp_ns, *report.world_from_camera, TrackingState::ok, false});
  }
  mailbox.rewrite_trajectory(path, "loop closed");
  const Mailbox::Contents contents = mailbox.take();
  EXPECT_EQ(contents.rewrite.value().trajectory.size(), 3U);
  ASSERT_EQ(contents.appended.size(), 1U);
  EXPECT_GT(contents.appended[0].timestamp_ns, path.back().timestamp_ns);
}

}  // namespace
}  // namespace flogmap
