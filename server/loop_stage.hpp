// The loop thread: takes mapped views, leaves corrections of the path.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "mapping/loop/loop_closer.hpp"
#include "mapping/view.hpp"
#include "server/bounded_queue.hpp"

namespace flogmap {

/// run() belongs to the loop thread, everything else to the thread that sees the frames.
class LoopStage {
 public:
  /// Of a live source, views are passed over when loops are not found as fast as views come; of a recording
  /// every view is looked at, so that the same recording gives the same map.
  LoopStage(const LoopOptions& options, const StereoCamera& camera, bool live);

  void offer(const View& view);

  /// The newest correction since the last call, or since the map began.
  std::optional<PathCorrection> take();

  /// Returns when every view offered so far has been looked at or passed over.
  void wait_for_rest();

  /// Forgets all views; what is still found for the map before is not told.
  void begin_map();

  void run();
  void close() { views_.close(); }

  /// Loops closed in this map. From any thread.
  [[nodiscard]] std::uint64_t num_loops() const { return num_loops_; }
  [[nodiscard]] std::size_t num_queued() const { return views_.size(); }

 private:
  struct Offered {
    std::uint64_t map = 0;
    std::optional<View> view;                     // nothing: only ...
    std::shared_ptr<std::promise<void>> reached;  // ... says that this has been reached
  };
  void look_at(LoopCloser& closer, const Offered& offered);

  const LoopOptions options_;
  const StereoCamera camera_;
  BoundedQueue<Offered> views_;
  std::atomic<std::uint64_t> num_loops_ = 0;

  std::mutex mutex_;
  std::uint64_t map_ = 0;  // counts the maps begun
  std::optional<PathCorrection> newest_;
};

}  // namespace flogmap
