#include "mapping/tile_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

namespace flogmap {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kChunkBytes = std::size_t{64} << 20U;  // the file grows by this much
constexpr std::chrono::seconds kTrimEvery{1};

std::size_t whole_pages(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

/// A file without a name, open for reading and writing.
int open_nameless(const std::filesystem::path& folder) {
  std::string path = (folder / "flogmap-tiles-XXXXXX").string();
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) {
    throw std::runtime_error("no file for the map's tiles can be made in " + folder.string() + ": " +
                             std::strerror(errno));
  }
  ::unlink(path.c_str());
  return file;
}

/// Blocks of a mapped file. The kernel keeps their bytes whether they are in memory or not; this class only
/// tells it which it may drop from memory.
class TileFile {
 public:
  TileFile(std::size_t limit_bytes, const std::filesystem::path& folder)
      : limit_(limit_bytes),
        file_(open_nameless(folder)),
        trimmer_([this](const std::stop_token& stop) { trim_now_and_then(stop); }) {}

  /// Null: the disk is full.
  void* allocate(std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    const std::size_t size = whole_pages(bytes);
    std::vector<char*>& free = free_[size];
    if (free.empty() && !carve(size, free)) return nullptr;
    char* block = free.back();
    free.pop_back();
    const std::uint64_t born = ++births_;
    living_[block] = {.size = size, .born = born, .out = false};
    by_age_.push_back({block, born});
    use_.allocated_bytes += size;
    in_memory_ += size;
    evict_oldest();
    return block;
  }

  bool deallocate(void* cells) {
    const std::scoped_lock lock(mutex_);
    const auto found = living_.find(static_cast<char*>(cells));
    if (found == living_.end()) return false;
    const auto [size, born, out] = found->second;
    use_.allocated_bytes -= size;
    (out ? use_.paged_out_bytes : in_memory_) -= size;
    free_[size].push_back(found->first);
    living_.erase(found);
    return true;
  }

  /// Reading brings blocks back without a word; this sends all away again that were away.
  void trim() {
    const std::scoped_lock lock(mutex_);
    for (const auto& [block, state] : living_) {
      if (state.out) drop(block, state.size);
    }
  }

  TileMemoryUse use() {
    const std::scoped_lock lock(mutex_);
    return use_;
  }

 private:
  struct Living {
    std::size_t size = 0;
    std::uint64_t born = 0;
    bool out = false;
  };
  struct Birth {
    char* block = nullptr;
    std::uint64_t born = 0;  // the block may have been given to another tile since
  };

  bool carve(std::size_t size, std::vector<char*>& free) {
    const std::size_t bytes = std::max(kChunkBytes / size, std::size_t{1}) * size;
    // Room on the disk is taken now: a page without it would end the program when it is written to.
    if (::posix_fallocate(file_, static_cast<off_t>(file_bytes_), static_cast<off_t>(bytes)) != 0)
      return false;
    void* chunk =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, static_cast<off_t>(file_bytes_));
    if (chunk == MAP_FAILED) return false;
    file_bytes_ += bytes;
    for (std::size_t at = bytes; at >= size; at -= size)
      free.push_back(static_cast<char*>(chunk) + at - size);
    return true;
  }

  /// A tile's cells never change once it is made: the oldest block is the tile unchanged for longest.
  void evict_oldest() {
    while (in_memory_ > limit_ && by_age_.size() > 1) {
      const Birth oldest = by_age_.front();
      by_age_.pop_front();
      const auto found = living_.find(oldest.block);
      if (found == living_.end() || found->second.born != oldest.born) continue;
      drop(oldest.block, found->second.size);
      found->second.out = true;
      in_memory_ -= found->second.size;
      use_.paged_out_bytes += found->second.size;
    }
  }

  /// The mapping is shared, so what was written is kept: in the kernel's cache at first, which it empties to
  /// the file by itself and gives away when others need the memory.
  static void drop(char* block, std::size_t size) { ::madvise(block, size, MADV_DONTNEED); }

  void trim_now_and_then(const std::stop_token& stop) {
    std::mutex asleep;
    std::unique_lock lock(asleep);
    while (!wake_.wait_for(lock, stop, kTrimEvery, [] { return false; }) && !stop.stop_requested()) trim();
  }

  const std::size_t limit_;
  const int file_;
  std::mutex mutex_;
  std::size_t file_bytes_ = 0;
  std::unordered_map<std::size_t, std::vector<char*>> free_;  // by size
  std::unordered_map<char*, Living> living_;
  std::deque<Birth> by_age_;  // in memory, oldest first, and some that are gone
  std::uint64_t births_ = 0;
  std::size_t in_memory_ = 0;
  TileMemoryUse use_;
  std::condition_variable_any wake_;
  std::jthread trimmer_;  // last: it uses all of the above
};

// Lives until the program ends, whatever the order in which the last tiles go.
std::atomic<TileFile*> tile_file = nullptr;

}  // namespace

void TileMemory::keep_within(std::size_t limit_bytes, const std::filesystem::path& folder) {
  if (tile_file != nullptr) throw std::logic_error("the memory of tiles was limited before");
  tile_file = std::make_unique<TileFile>(limit_bytes, folder).release();
}

void* TileMemory::allocate(std::size_t bytes) {
  if (TileFile* file = tile_file; file != nullptr && bytes >= kPage) {
    if (void* cells = file->allocate(bytes)) return cells;
  }
  return ::operator new(bytes);
}

void TileMemory::deallocate(void* cells, std::size_t bytes) noexcept {
  TileFile* file = tile_file;
  if (file != nullptr && bytes >= kPage && file->deallocate(cells)) return;
  ::operator delete(cells);
}

void TileMemory::trim() {
  if (TileFile* file = tile_file) file->trim();
}

TileMemoryUse TileMemory::use() {
  TileFile* file = tile_file;
  return file != nullptr ? file->use() : TileMemoryUse{};
}

}  // namespace flogmap
