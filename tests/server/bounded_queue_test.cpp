#include "server/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

namespace flogmap {
namespace {

TEST(BoundedQueue, KeepsOrderAndLosesNothingWhenItWaits) {
  constexpr int kCount = 20'000;
  BoundedQueue<int> queue(3, WhenFull::wait);
  std::jthread writer([&] {
    for (int i = 0; i < kCount; ++i) ASSERT_TRUE(queue.push(i));
    queue.close();
  });
  int expected = 0;
  while (const auto value = queue.pop()) ASSERT_EQ(*value, expected++);
  EXPECT_EQ(expected, kCount);
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(BoundedQueue, KeepsTheNewestAndCountsTheRestWhenItDrops) {
  BoundedQueue<int> queue(2, WhenFull::drop_oldest);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(queue.push(i));
  queue.close();
  EXPECT_EQ(queue.pop(), 8);
  EXPECT_EQ(queue.pop(), 9);
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_EQ(queue.dropped(), 8U);
}

TEST(BoundedQueue, ClosingWakesAWaitingWriterAndAWaitingReader) {
  BoundedQueue<int> full(1, WhenFull::wait);
  ASSERT_TRUE(full.push(1));
  std::atomic<bool> taken = true;
  std::jthread writer([&] { taken = full.push(2); });
  full.close();
  writer.join();
  EXPECT_FALSE(taken);
  EXPECT_EQ(full.pop(), 1);

  BoundedQueue<int> empty(1, WhenFull::wait);
  std::atomic<bool> got = true;
  std::jthread reader([&] { got = empty.pop().has_value(); });
  empty.close();
  reader.join();
  EXPECT_FALSE(got);
}

TEST(BoundedQueue, PushAfterCloseIsRefused) {
  BoundedQueue<int> queue(4, WhenFull::drop_oldest);
  queue.close();
  EXPECT_FALSE(queue.push(1));
  EXPECT_EQ(queue.pop(), std::nullopt);
}

}  // namespace
}  // namespace flogmap
