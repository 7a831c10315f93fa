#pragma once

#include <atomic>
#include <functional>

#include "server/query_worker.hpp"
#include "server/viewers.hpp"

namespace flogmap {

/// Brings the newest pictures to the pages that want them: each size encoded once, on a thread of its own,
/// and only while somebody waits for it.
class PictureService {
 public:
  /// Runs a function on the network thread; may be called from any thread.
  using Post = std::function<void(std::function<void()>)>;

  PictureService(ServerState& state, Viewers& viewers, Post post);

  /// Starts encoding if a picture is wanted; call when pictures or wishes may be new.
  void offer();
  void stop() { encoder_.stop(); }

  /// Somebody looks at pictures; from any thread.
  [[nodiscard]] bool wanted() const { return wanted_; }

 private:
  void encode(PictureKey key);

  ServerState& state_;
  Viewers& viewers_;
  Post post_;
  bool encoding_ = false;
  std::atomic<bool> wanted_{false};
  QueryWorker encoder_{1};
};

}  // namespace flogmap
