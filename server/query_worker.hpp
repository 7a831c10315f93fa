#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace flogmap {

/// One thread for work that would hold up the network thread. Jobs own all they need; when the queue is full
/// the answer is no, never a wait.
class QueryWorker {
 public:
  explicit QueryWorker(std::size_t max_waiting);
  ~QueryWorker() { stop(); }
  QueryWorker(const QueryWorker&) = delete;
  QueryWorker& operator=(const QueryWorker&) = delete;

  /// False if the queue is full. A job must not throw.
  bool submit(std::function<void()> job);

  /// Finishes the job at hand, drops the others, and takes no more.
  void stop();

  [[nodiscard]] std::size_t num_waiting() const;

 private:
  void work(const std::stop_token& stop);

  std::size_t max_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<std::function<void()>> jobs_;
  bool stopped_ = false;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace flogmap
