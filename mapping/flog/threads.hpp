// The same work on several threads at once.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace flogmap {

/// How many threads to use; 0 asks for one per processor.
inline int threads_for(int wanted) {
  if (wanted > 0) return wanted;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
}

/// Calls work(0) ... work(num_threads - 1) at the same time and returns when all have ended. work must not
/// throw.
template <typename Work>
void run_on_threads(int num_threads, const Work& work) {
  std::vector<std::jthread> others;
  for (int i = 1; i < num_threads; ++i) others.emplace_back([&work, i] { work(i); });
  work(0);
}

}  // namespace flogmap
