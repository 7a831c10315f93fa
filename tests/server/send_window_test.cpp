// What a client has on the way follows what its line carries: nothing waits long on a slow line, nothing is
// wasted on a quick one.
#include "server/send_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace flogmap {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Time = SendWindow::Time;

/// A line that carries so many bytes a second, and a page that answers each message as it arrives.
class Line {
 public:
  Line(double bytes_per_s, milliseconds round_trip) : rate_(bytes_per_s), round_trip_(round_trip) {}

  void set_rate(double bytes_per_s) { rate_ = bytes_per_s; }

  /// Sends as much as may be, for so long; returns how long each message took to be answered.
  std::vector<double> fill(milliseconds time, std::size_t message_bytes = 0) {
    std::vector<double> took_s;
    for (const Time end = now_ + time; now_ < end; now_ += milliseconds(1)) {
      for (; !answers_.empty() && answers_.front().at <= now_; answers_.pop_front()) {
        EXPECT_TRUE(window.acknowledge(answers_.front().total, now_));
        took_s.push_back(duration<double>(now_ - answers_.front().sent_at).count());
      }
      if (message_bytes == 0) {
        while (window.open(now_)) send(window.batch_bytes());
      } else if (answers_.empty()) {  // one small message at a time
        send(message_bytes);
      }
    }
    return took_s;
  }

  [[nodiscard]] std::uint64_t allowed_bytes() const { return window.bytes(now_); }

  SendWindow window{WireLimits{}};
  double sent_bytes = 0;

 private:
  struct Answer {
    Time at, sent_at;
    std::uint64_t total;
  };

  void send(std::size_t bytes) {
    window.sent(bytes, now_);
    sent_bytes += static_cast<double>(bytes);
    free_at_ = std::max(free_at_, now_) +
               duration_cast<Time::duration>(duration<double>(static_cast<double>(bytes) / rate_));
    answers_.push_back({free_at_ + round_trip_, now_, static_cast<std::uint64_t>(sent_bytes)});
  }

  double rate_;
  milliseconds round_trip_;
  Time now_{std::chrono::hours(1)};
  Time free_at_{};
  std::deque<Answer> answers_;
};

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

TEST(SendWindow, OnASlowLineNothingWaitsLongAndTheLineIsFull) {
  for (const double rate : {20e3, 30e3, 100e3, 300e3}) {
    Line line(rate, milliseconds(200));
    const double least_s = static_cast<double>(SendWindow::kLeastBytes) / rate + 0.2;
    EXPECT_LT(largest(line.fill(seconds(60))), std::max(1.2 * least_s, 3.0)) << rate;
    EXPECT_GT(line.sent_bytes, 0.9 * 60 * rate) << rate;
  }
}

TEST(SendWindow, APageThatIsAlwaysLateStillGetsItsShare) {
  Line line(20e6, milliseconds(1200));  // busy with other things, not with what we send
  line.fill(seconds(5));
  const double before = line.sent_bytes;
  line.fill(seconds(30));
  EXPECT_GT(line.sent_bytes - before, 100e3 * 30);
}

TEST(SendWindow, OnAQuickLineItIsAllowedInAMoment) {
  Line line(100e6, milliseconds(1));
  line.fill(milliseconds(50));
  EXPECT_EQ(line.allowed_bytes(), WireLimits{}.max_unacknowledged_bytes);
  EXPECT_EQ(line.window.batch_bytes(), WireLimits{}.max_batch_bytes);
}

TEST(SendWindow, ALongWayIsNotTakenForASlowLine) {
  Line line(20e6, milliseconds(600));
  line.fill(seconds(6));
  EXPECT_EQ(line.allowed_bytes(), WireLimits{}.max_unacknowledged_bytes);
}

TEST(SendWindow, ALineThatTurnsSlowIsNoticed) {
  Line line(10e6, milliseconds(20));
  line.fill(seconds(2));
  line.set_rate(50e3);
  line.fill(seconds(30));  // a whole window of the quick line is on the way
  EXPECT_LT(largest(line.fill(seconds(30))), 3.0);
  line.set_rate(10e6);
  line.fill(seconds(2));
  EXPECT_EQ(line.allowed_bytes(), WireLimits{}.max_unacknowledged_bytes);
}

TEST(SendWindow, SmallMessagesSayNothingAboutLargeOnes) {
  Line line(30e3, milliseconds(50));
  line.fill(seconds(30), 500);
  EXPECT_EQ(line.allowed_bytes(), SendWindow::kLeastBytes);
}

TEST(SendWindow, ALateAnswerIsKnownBeforeItComes) {
  SendWindow window{WireLimits{}};
  const Time start{std::chrono::hours(1)};
  EXPECT_FALSE(window.behind(start));
  window.sent(1000, start);
  EXPECT_TRUE(window.acknowledge(1000, start + milliseconds(100)));
  window.sent(1000, start + seconds(1));
  EXPECT_FALSE(window.behind(start + milliseconds(1300)));
  EXPECT_TRUE(window.behind(start + milliseconds(1500)));
  EXPECT_TRUE(window.acknowledge(2000, start + milliseconds(1600)));
  EXPECT_FALSE(window.behind(start + seconds(9)));
}

TEST(SendWindow, AClientThatAcknowledgesSeldomStillGetsEverything) {
  constexpr std::uint64_t kSeldom = 512U << 10U, kAll = 8U << 20U;
  SendWindow window{WireLimits{}};
  Time now{std::chrono::hours(1)};
  std::uint64_t sent = 0, answered = 0;
  for (const Time end = now + seconds(60); now < end && sent < kAll; now += milliseconds(10)) {
    while (window.open(now)) {
      window.sent(window.batch_bytes(), now);
      sent += window.batch_bytes();
    }
    ASSERT_LE(window.unacknowledged(), WireLimits{}.max_unacknowledged_bytes);
    ASSERT_FALSE(window.overdue(now));
    if (sent - answered < kSeldom) continue;
    answered = sent;
    ASSERT_TRUE(window.acknowledge(answered, now));
  }
  EXPECT_GE(sent, kAll);
}

TEST(SendWindow, WhenItOpensByItselfIsKnown) {
  SendWindow window{WireLimits{}};
  const Time start{std::chrono::hours(1)};
  EXPECT_FALSE(window.opens_at(start));
  window.sent(SendWindow::kLeastBytes, start);
  EXPECT_FALSE(window.open(start));
  const auto opens = window.opens_at(start);
  ASSERT_TRUE(opens);
  EXPECT_FALSE(window.open(*opens - milliseconds(1)));
  EXPECT_TRUE(window.open(*opens));
  EXPECT_FALSE(window.opens_at(*opens)) << "nobody waits for a time that is past";
}

TEST(SendWindow, MoreThanWasSentCannotBeAcknowledged) {
  SendWindow window{WireLimits{}};
  const Time start{std::chrono::hours(1)};
  window.sent(1000, start);
  EXPECT_FALSE(window.acknowledge(1001, start));
  EXPECT_FALSE(window.overdue(start + seconds(29)));
  EXPECT_TRUE(window.overdue(start + seconds(30)));
  EXPECT_TRUE(window.acknowledge(400, start + seconds(30)));
  EXPECT_FALSE(window.overdue(start + seconds(59)));  // it lives, however slowly
}

}  // namespace
}  // namespace flogmap
