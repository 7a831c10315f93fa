// Independent pieces of work on several threads. The pieces never depend on the number of threads, so
// neither does what they compute.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace flogmap {

/// 0 = every core.
inline int threads_to_use(int num_threads) {
  return num_threads > 0 ? num_threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls work(worker, index) once for every index in [0, count); worker in [0, num_threads) tells threads
/// apart.
template <typename Work>
void parallel_for(int num_threads, int count, const Work& work) {
  std::atomic<int> next{0};
  const auto run = [&](int worker) {
    for (int index = next++; index < count; index = next++) work(worker, index);
  };
  std::vector<std::jthread> others;
  for (int worker = 1; worker < std::min(num_threads, count); ++worker) others.emplace_back(run, worker);
  run(0);
}

}  // namespace flogmap
