#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace flogmap::mcap {

/// Pieces of a file, which may be larger than the memory.
class FileBytes {
 public:
  /// Throws std::runtime_error naming the file if it cannot be read.
  explicit FileBytes(std::string path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// The bytes from `offset` on; fewer than `count` where the file ends or cannot be read.
  [[nodiscard]] std::vector<std::uint8_t> read(std::uint64_t offset, std::uint64_t count);

 private:
  std::string path_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

}  // namespace flogmap::mcap
