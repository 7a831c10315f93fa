// Which core a thread runs on, so that a bench can say what shared one and what did not.
#pragma once

#include <sched.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <thread>

namespace flogmap {

/// The mapping has a core of its own; network and load share the other.
inline constexpr int kMappingCore = 0, kNetworkCore = 1;

/// A thread (0: the calling one) and those that it starts from now on keep to one core. Does nothing where
/// there is only one; false if the system refuses.
inline bool keep_to_core(pid_t thread, int core) {
  if (std::thread::hardware_concurrency() < 2) return false;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  return sched_setaffinity(thread, sizeof cores, &cores) == 0;
}

/// The calling thread may run anywhere again.
inline void keep_to_no_core() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  for (unsigned core = 0; core < std::thread::hardware_concurrency(); ++core) CPU_SET(core, &cores);
  sched_setaffinity(0, sizeof cores, &cores);
}

/// All threads of a running flogmap: the first, which serves, keeps to the network's core, the others to the
/// mapping's.
inline void keep_program_to_cores(pid_t program) {
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(program) + "/task")) {
    const pid_t thread = std::stoi(task.path().filename().string());
    keep_to_core(thread, thread == program ? kNetworkCore : kMappingCore);
  }
}

}  // namespace flogmap
