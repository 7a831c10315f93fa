#include "server/commands/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace flogmap {
namespace {
constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawEvery{100};
}  // namespace

ProgressBar::ProgressBar(std::string job, std::int64_t total)
    : job_(std::move(job)),
      total_(std::max<std::int64_t>(total, 1)),
      on_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(std::int64_t done, const std::string& note) {
  done_ = done;
  note_ = note;
  if (!on_terminal_ || Clock::now() - drawn_ < kRedrawEvery) return;
  drawn_ = Clock::now();
  draw(done, note);
}

void ProgressBar::draw(std::int64_t done, const std::string& note) const {
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  const double left_s = rate > 0 ? static_cast<double>(total_ - done) / rate : 0;
  const std::string filled(static_cast<std::size_t>(share * kBarWidth), '#');
  std::fprintf(stderr, "\r%s [%-*s] %lld/%lld  %.1f/s  %.0f s left  %s\033[K", job_.c_str(), kBarWidth,
               filled.c_str(), static_cast<long long>(done), static_cast<long long>(total_), rate,
               std::max(0.0, left_s), note.c_str());
}

void ProgressBar::finish() {
  if (!on_terminal_) return;
  draw(done_, note_);
  std::fputc('\n', stderr);
}

}  // namespace flogmap
