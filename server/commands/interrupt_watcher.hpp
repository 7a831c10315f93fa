#pragma once

#include <functional>
#include <thread>

namespace flogmap {

/// While it lives, SIGINT and SIGTERM call `on_interrupt` in a thread of its own instead of ending the
/// process; once, so that a second Ctrl-C ends it for good. Make it before other threads: they inherit the
/// blocked signals.
class InterruptWatcher {
 public:
  explicit InterruptWatcher(std::function<void()> on_interrupt);
  ~InterruptWatcher();
  InterruptWatcher(const InterruptWatcher&) = delete;
  InterruptWatcher& operator=(const InterruptWatcher&) = delete;

 private:
  int signals_ = -1;  // file descriptors
  int wake_ = -1;
  std::jthread thread_;
};

}  // namespace flogmap
