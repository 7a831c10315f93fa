#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace flogmap {

/// What push() does when the queue is full.
enum class WhenFull : std::uint8_t {
  wait,         // recordings: every frame counts
  drop_oldest,  // live: the newest picture counts
};

/// Hands values from one thread to the next. Closing it ends the reader's loop once it is drained.
template <typename T>
class BoundedQueue {
 public:
  BoundedQueue(std::size_t capacity, WhenFull when_full) : capacity_(capacity), when_full_(when_full) {}

  /// False, and the value is gone, once the queue is closed.
  bool push(T value) {
    std::unique_lock lock(mutex_);
    if (when_full_ == WhenFull::wait) {
      room_.wait(lock, [&] { return closed_ || values_.size() < capacity_; });
    }
    if (closed_) return false;
    if (values_.size() >= capacity_) {
      values_.pop_front();
      ++dropped_;
    }
    values_.push_back(std::move(value));
    lock.unlock();
    filled_.notify_one();
    return true;
  }

  /// The oldest value; blocks. Nothing once the queue is closed and drained.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [&] { return closed_ || !values_.empty(); });
    return take_first(lock);
  }

  /// The oldest value if there is one; does not wait.
  std::optional<T> try_pop() {
    std::unique_lock lock(mutex_);
    return take_first(lock);
  }

  void close() {
    {
      const std::scoped_lock lock(mutex_);
      closed_ = true;
    }
    room_.notify_all();
    filled_.notify_all();
  }

  /// Closes it and throws away what is in it: its reader has failed.
  void abandon() {
    close();
    std::deque<T> thrown_away;
    const std::scoped_lock lock(mutex_);
    thrown_away.swap(values_);
  }

  [[nodiscard]] std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return values_.size();
  }

  /// Values that had to go to make room; always 0 with WhenFull::wait.
  [[nodiscard]] std::uint64_t dropped() const {
    const std::scoped_lock lock(mutex_);
    return dropped_;
  }

 private:
  std::optional<T> take_first(std::unique_lock<std::mutex>& lock) {
    if (values_.empty()) return std::nullopt;
    std::optional<T> value(std::move(values_.front()));
    values_.pop_front();
    lock.unlock();
    room_.notify_one();
    return value;
  }

  const std::size_t capacity_;
  const WhenFull when_full_;
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  std::deque<T> values_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace flogmap
