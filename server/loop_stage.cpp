#include "server/loop_stage.hpp"

#include <utility>

namespace flogmap {
namespace {

constexpr std::size_t kQueue = 4;

}  // namespace

LoopStage::LoopStage(const LoopOptions& options, const StereoCamera& camera, bool live)
    : options_(options), camera_(camera), views_(kQueue, live ? WhenFull::drop_oldest : WhenFull::wait) {}

void LoopStage::offer(const View& view) { views_.push({.map = map_, .view = view, .reached = nullptr}); }

std::optional<PathCorrection> LoopStage::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(newest_, std::nullopt);
}

void LoopStage::wait_for_rest() {
  auto reached = std::make_shared<std::promise<void>>();
  std::future<void> done = reached->get_future();
  if (views_.push({.map = map_, .view = {}, .reached = std::move(reached)})) done.wait();
}

void LoopStage::begin_map() {
  const std::scoped_lock lock(mutex_);
  ++map_;
  newest_.reset();
  num_loops_ = 0;
}

void LoopStage::run() {
  try {
    std::optional<LoopCloser> closer;
    std::uint64_t map = 0;
    while (const std::optional<Offered> offered = views_.pop()) {
      if (!closer || std::exchange(map, offered->map) != offered->map) closer.emplace(options_, camera_);
      look_at(*closer, *offered);
    }
  } catch (...) {
    views_.abandon();  // nobody waits for a promise that cannot be kept
    throw;
  }
}

void LoopStage::look_at(LoopCloser& closer, const Offered& offered) {
  if (offered.view) {
    std::optional<LoopCorrection> correction = closer.add(*offered.view);
    const std::scoped_lock lock(mutex_);
    if (offered.map == map_) {
      num_loops_ = static_cast<std::uint64_t>(closer.num_loops());
      if (correction) newest_ = std::move(correction->path);
    }
  }
  if (offered.reached) offered.reached->set_value();
}

}  // namespace flogmap
