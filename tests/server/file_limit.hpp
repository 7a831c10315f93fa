// A full disk, without filling one.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace flogmap {

/// Until the end of the scope no file may grow beyond `bytes`, neither of this process nor of those that it
/// starts meanwhile; 0: no file takes a byte.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);  // inherited: writing beyond the limit is an error, as on a full disk
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace flogmap
