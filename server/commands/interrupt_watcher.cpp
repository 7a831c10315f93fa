#include "server/commands/interrupt_watcher.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <utility>

namespace flogmap {
namespace {

sigset_t interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

/// One press may come as several signals, to the process and to its group.
constexpr int kSamePress_ms = 200;

/// Waits for a signal and takes it; false if woken, or after so long.
bool take_signal(int signals, int wake, int patience_ms) {
  std::array<pollfd, 2> events{pollfd{signals, POLLIN, 0}, pollfd{wake, POLLIN, 0}};
  int num_ready = -1;
  while ((num_ready = poll(events.data(), events.size(), patience_ms)) < 0) {
  }
  signalfd_siginfo taken{};
  return num_ready > 0 && (events[0].revents & POLLIN) != 0 &&
         read(signals, &taken, sizeof taken) == static_cast<ssize_t>(sizeof taken);
}

}  // namespace

InterruptWatcher::InterruptWatcher(std::function<void()> on_interrupt) {
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC);
  wake_ = eventfd(0, EFD_CLOEXEC);
  thread_ = std::jthread([this, set, act = std::move(on_interrupt)] {
    if (!take_signal(signals_, wake_, -1)) return;
    act();
    while (take_signal(signals_, wake_, kSamePress_ms)) {
    }
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);  // the next one comes here and ends the process
    pollfd woken{wake_, POLLIN, 0};
    while (poll(&woken, 1, -1) < 0) {
    }
  });
}

InterruptWatcher::~InterruptWatcher() {
  const std::uint64_t one = 1;
  if (write(wake_, &one, sizeof one) < 0) return;
  thread_.join();
  close(signals_);
  close(wake_);
  const sigset_t set = interrupts();
  const timespec at_once{};
  while (sigtimedwait(&set, nullptr, &at_once) > 0) {
  }  // the same press again: what it asked for has been done
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace flogmap
