// Where the cells of tiles lie, and how much of them stays in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <new>

namespace flogmap {

struct TileMemoryUse {
  std::size_t allocated_bytes = 0;  // of all living tiles
  std::size_t paged_out_bytes = 0;  // of them, given to the file and not to be found in memory since
};

/// The memory of all tiles of this program. By default it is the heap. With a limit it is a file that the
/// operating system maps: tiles that have not changed for long leave the memory for the file, and come back
/// by themselves when they are read. What reads a tile need not know.
class TileMemory {
 public:
  /// Keeps about `limit_bytes` of cells in memory from now on, the rest in a nameless file in `folder`, which
  /// vanishes with the program however it ends. Call it before the first tile is made, once. Throws
  /// std::runtime_error naming the folder if no file can be made there. If the disk fills up later, new tiles
  /// stay on the heap, and the limit is not kept.
  static void keep_within(std::size_t limit_bytes, const std::filesystem::path& folder);

  /// Throws std::bad_alloc. Thread-safe, as is all that follows.
  static void* allocate(std::size_t bytes);
  static void deallocate(void* cells, std::size_t bytes) noexcept;

  /// Sends away now what has come back by being read and has not changed for long. Happens once a second too.
  static void trim();
  static TileMemoryUse use();
};

/// For the containers of cells: std::vector<Cell, TileAllocator<Cell>>.
template <typename T>
struct TileAllocator {
  using value_type = T;
  TileAllocator() = default;
  template <typename U>
  TileAllocator(const TileAllocator<U>& /*other*/) noexcept {}  // NOLINT: an allocator converts silently

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(TileMemory::allocate(count * sizeof(T)));
  }
  void deallocate(T* cells, std::size_t count) noexcept { TileMemory::deallocate(cells, count * sizeof(T)); }
  bool operator==(const TileAllocator&) const = default;
};

}  // namespace flogmap
