#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace flogmap {

/// `flogmap serve ...` as a process of its own on a free loopback port, with a JSON log. Killed at the end of
/// the scope if it still runs.
class RunningProgram {
 public:
  /// Arguments after "serve"; `environment` holds lines NAME=value. Throws what the program said if it does
  /// not come up within 30 s.
  RunningProgram(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] pid_t pid() const { return pid_; }

  /// Sends a signal (0: none) and waits; the exit code, or -signal if it was killed.
  int end(int signal);

  /// Closes the pipe that it writes its log to, after the next line.
  void hang_up() { hung_up_ = true; }

  /// What it wrote to stderr so far, a line each.
  [[nodiscard]] std::vector<std::string> log() const;
  /// Waits until a line of the log holds this; false after `patience`.
  bool wait_for_log(const std::string& part, std::chrono::seconds patience);

 private:
  void listen(int pipe);

  pid_t pid_ = -1;
  std::uint16_t port_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable more_;
  std::vector<std::string> log_;
  bool closed_ = false;
  std::atomic<bool> hung_up_ = false;
  std::thread listener_;
};

}  // namespace flogmap
