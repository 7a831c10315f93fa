#include "camera/mcap/file_bytes.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace flogmap::mcap {

FileBytes::FileBytes(std::string path) : path_(std::move(path)) {
  if (!std::filesystem::is_regular_file(path_)) throw std::runtime_error(path_ + ": no such file");
  in_.open(path_, std::ios::binary);
  if (!in_) throw std::runtime_error(path_ + ": cannot be opened");
  size_ = std::filesystem::file_size(path_);
}

std::vector<std::uint8_t> FileBytes::read(std::uint64_t offset, std::uint64_t count) {
  if (offset >= size_) return {};
  std::vector<std::uint8_t> bytes(std::min(count, size_ - offset));
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(offset));
  in_.read(reinterpret_cast<char*>(bytes.data()), std::ssize(bytes));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in_.gcount(), 0)));
  return bytes;
}

}  // namespace flogmap::mcap
