#include "server/store/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/store/sqlite.hpp"

namespace flogmap {
namespace {

std::string holder_of(int descriptor) {
  std::array<char, 32> text{};
  const auto size = ::pread(descriptor, text.data(), text.size() - 1, 0);
  return size > 0 ? " (process " + std::string(text.data(), static_cast<std::size_t>(size)) + ")" : "";
}

/// Whether the name still leads to what was opened: the last owner may just have removed it.
bool is_still_there(int descriptor, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

/// As SQLite would call it, had it come so far.
SqliteFault fault_of_open(int error) {
  if (error == ENOSPC || error == EDQUOT) return SqliteFault::disk_full;
  if (error == EROFS || error == EACCES || error == EPERM) return SqliteFault::read_only;
  return error == EIO ? SqliteFault::disk_error : SqliteFault::cannot_open;
}

void write_process_id(int descriptor) {
  const std::string id = std::to_string(::getpid());
  if (::ftruncate(descriptor, 0) != 0 || ::pwrite(descriptor, id.data(), id.size(), 0) < 0) {
    return;  // only a courtesy to whoever meets the lock; a full disk must not forbid it
  }
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& path) : lock_path_(path.string() + ".lock") {
  while (descriptor_ < 0) {
    const int descriptor = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0) {
      throw SqliteError(fault_of_open(errno), path.string() + ": cannot be written (" + std::strerror(errno) +
                                                  "); choose a folder that exists and may be written");
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const std::string holder = holder_of(descriptor);
      ::close(descriptor);
      throw std::runtime_error(path.string() + ": another flogmap" + holder +
                               " is writing to it; stop that one, or choose another file");
    }
    if (is_still_there(descriptor, lock_path_)) {
      descriptor_ = descriptor;
    } else {
      ::close(descriptor);
    }
  }
  write_process_id(descriptor_);
}

FileLock::FileLock(FileLock&& other) noexcept
    : lock_path_(std::move(other.lock_path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(lock_path_, other.lock_path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(lock_path_.c_str());
  ::close(descriptor_);
}

}  // namespace flogmap
