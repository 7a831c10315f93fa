// Rule 5: after any sequence of updates, stalls, disconnects and resumes, once quiet, the client's tiles are
// the server's, byte for byte; and on the way nothing grows. Thousands of seeded schedules against the real
// parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <random>

#include "flogmap/v1/stream.pb.h"
#include "server/outbox.hpp"
#include "tests/server/tile_mirror.hpp"

namespace flogmap {
namespace {

constexpr WireLimits kSmall{
    .max_unacknowledged_bytes = 4096, .max_batch_bytes = 1024, .max_client_frame_bytes = 65536};

/// One page, one connection at a time, over a line that holds back messages, and the map that it looks at.
class Schedule {
 public:
  explicit Schedule(std::uint32_t seed) : random_(seed) {
    choice_.planes = chance(0.5) ? Planes::evidence : Planes::value;
    begin_map();
    connect();
  }

  void act() {
    switch (pick(14)) {
      case 0:
      case 1:
      case 2:
      case 3:
        return publish();
      case 4:
      case 5:
        return deliver(pick(4));
      case 6:
        return acknowledge();
      case 7:
        return look();
      case 8:
        return forget();
      case 9:
        if (chance(0.4)) connect();
        return;
      case 10:
        if (chance(0.15)) begin_map();
        return;
      case 11:
        return walk();
      case 12:
        if (chance(0.3)) resubscribe();
        return;
      default:
        now_ += std::chrono::milliseconds(pick(250));
    }
    serve(pick(3));
  }

  /// Nothing changes any more and the line is good.
  void settle() {
    for (int round = 0; round < 200; ++round) {
      now_ += std::chrono::milliseconds(150);
      deliver(line_.size());
      acknowledge();
      serve(1000);
      if (line_.empty()) return;
    }
    FAIL() << "never gets quiet";
  }

  [[nodiscard]] std::string result() { return difference(page_, *map_, choice_); }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }

  void begin_map() {
    MapBegin begin;
    begin.epoch = "epoch" + std::to_string(++num_epochs_);
    begin.info.grid.layer_bounds_m = {0, 1};
    begin.info.full_confidence_rays = {10};
    revision_ = 0;
    map_ = std::make_unique<ServedMap>("live", std::move(begin), Operators::algebraic);
    if (!outbox_) return;
    outbox_->control(to_shared(encode_reset(map_->header(), "reset")));
    outbox_->reset(*map_);
    sent_ = {};
  }

  void connect() {
    outbox_ = std::make_unique<Outbox>(kSmall);
    line_.clear();
    page_.reconnect();
    sent_ = page_;  // of what was on the line nothing arrives
    outbox_->control(to_shared(encode_welcome(map_->header(), kSmall, "view", "test")));
    if (page_.epoch() == map_->epoch()) {
      outbox_->resume({page_.epoch(), page_.complete_revision(), page_.path_ns().size()}, *map_);
      outbox_->forget({page_.forgotten().begin(), page_.forgotten().end()}, *map_);
    } else if (!page_.epoch().empty()) {
      outbox_->control(to_shared(encode_reset(map_->header(), "another map")));
    }
    outbox_->subscribe({choice_, {}, 0, false}, *map_);
  }

  /// The page changes planes: it empties its store, for the same revisions come in another form.
  void resubscribe() {
    deliver(line_.size());
    choice_.planes = choice_.planes == Planes::value ? Planes::evidence : Planes::value;
    std::vector<TileKey> all;
    for (const auto& [key, tile] : page_.tiles()) all.push_back(key);
    page_.forget(all);
    sent_ = page_;
    outbox_->subscribe({choice_, {}, 0, false}, *map_);
  }

  void publish() {
    ++revision_;
    std::vector<TileUpdate> updates;
    for (int i = pick(4); i >= 0; --i) {
      const TileIndex index{pick(5) - 2, pick(5) - 2};
      if (chance(0.1)) {
        updates.push_back({index, revision_, nullptr});
        continue;
      }
      Tile tile{TileCells(kTileColumns), revision_};
      for (int n = 0; n < 60; ++n) {
        const auto E = static_cast<std::uint16_t>(pick(30000)), O = static_cast<std::uint16_t>(pick(30000));
        tile.cells[pick(kTileColumns)] = {E, O, static_cast<std::uint16_t>(1 + pick(20)), O};
      }
      updates.push_back({index, revision_, std::make_shared<const Tile>(std::move(tile))});
    }
    outbox_->changed(map_->update(revision_, updates));
  }

  void walk() {
    if (chance(0.2) && !map_->trajectory().empty()) {
      auto path = map_->trajectory();
      path.resize(path.size() / 2 + 1);
      map_->rewrite(path);
      outbox_->rewritten("loop");
    }
    for (int i = pick(3); i >= 0; --i) map_->append({++time_ns_, SE3::Identity(), TrackingState::ok, false});
  }

  void look() {
    const double x = pick(6) - 3, y = pick(6) - 3;
    outbox_->look_at({{x, y, x + 1 + pick(3), y + 1 + pick(3)}, static_cast<std::uint32_t>(pick(3))}, *map_);
  }

  void forget() {
    std::vector<TileKey> keys;
    for (const auto& [key, tile] : page_.tiles()) {
      if (chance(0.2)) keys.push_back(key);
    }
    outbox_->forget(keys, *map_);
    page_.forget(keys);
    sent_.forget(keys);
  }

  void acknowledge() { EXPECT_TRUE(outbox_->acknowledge(page_.batch_bytes(), now_)); }

  void deliver(std::size_t count) {
    for (; count > 0 && !line_.empty(); --count) {
      page_.take(*line_.front());
      line_.pop_front();
    }
  }

  void serve(int count) {
    for (; count > 0; --count) {
      const Bytes message = outbox_->next(*map_, now_);
      check_bounds(message);
      if (!message) return;
      line_.push_back(message);
      sent_.take(*message);
      check_claim(*message);
    }
  }

  void check_bounds(const Bytes& message) {
    EXPECT_LE(outbox_->num_pending(), map_->board().num_slots());
    EXPECT_LE(outbox_->memory_bytes(), 64 * 1024);
    EXPECT_LE(outbox_->unacknowledged(),
              kSmall.max_unacknowledged_bytes + 12 * 1024);  // one tile may be larger
    EXPECT_LE(message ? message->size() : 0, kSmall.max_batch_bytes + 12 * 1024);
  }

  /// "Complete as of rev" is true of what was sent until then.
  void check_claim(const std::string& bytes) {
    v1::ServerMessage message;
    ASSERT_TRUE(message.ParseFromString(bytes));
    if (!message.has_tile_batch() || !message.tile_batch().complete()) return;
    TileBoard& board = map_->board();
    for (Slot slot = 0; slot < board.num_slots(); ++slot) {
      if (!board.exists(slot) || board.revision(slot) > message.tile_batch().rev()) continue;
      if (sent_.forgotten().count(board.key(slot)) > 0) continue;
      const auto held = sent_.tiles().find(board.key(slot));
      ASSERT_TRUE(held != sent_.tiles().end());
      EXPECT_EQ(held->second.revision, board.revision(slot));
    }
  }

  std::mt19937 random_;
  std::unique_ptr<ServedMap> map_;
  std::unique_ptr<Outbox> outbox_;
  TileChoice choice_;
  TileMirror page_;
  TileMirror sent_;  // as if everything sent had arrived
  std::deque<Bytes> line_;
  Outbox::Time now_{std::chrono::hours(1)};
  std::uint64_t revision_ = 0;
  std::int64_t time_ns_ = 0;
  int num_epochs_ = 0;
};

TEST(OutboxLaw, OnceQuietTheClientHoldsTheServersTilesByteForByte) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    Schedule schedule(seed);
    for (int step = 0; step < 40; ++step) schedule.act();
    schedule.settle();
    ASSERT_EQ(schedule.result(), "") << "seed " << seed;
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

}  // namespace
}  // namespace flogmap
