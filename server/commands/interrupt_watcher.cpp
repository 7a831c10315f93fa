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

}  // namespace

InterruptWatcher::InterruptWatcher(std::function<void()> on_interrupt) {
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC);
  wake_ = eventfd(0, EFD_CLOEXEC);
  thread_ = std::jthread([this, set, act = std::move(on_interrupt)] {
    std::array<pollfd, 2> events{pollfd{signals_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
    while (poll(events.data(), events.size(), -1) < 0) {
    }
    if ((events[0].revents & POLLIN) == 0) return;
    signalfd_siginfo taken{};
    if (read(signals_, &taken, sizeof taken) != static_cast<ssize_t>(sizeof taken)) return;
    close(std::exchange(signals_, -1));
    act();
  });
}

InterruptWatcher::~InterruptWatcher() {
  const std::uint64_t one = 1;
  if (write(wake_, &one, sizeof one) < 0) return;
  thread_.join();
  if (signals_ >= 0) close(signals_);
  close(wake_);
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace flogmap
