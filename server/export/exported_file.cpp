#include "server/export/exported_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <string_view>

namespace flogmap {
namespace {

constexpr std::size_t kTarBlock = 512;

using TarHeader = std::array<char, kTarBlock>;

void put(TarHeader& header, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string octal(std::size_t value, int digits) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "%0*zo", digits, value);
  return text.data();
}

/// POSIX.1-1988 "ustar" header: name, mode, owner, size, time, checksum, type, magic.
TarHeader tar_header(const ExportedFile& file) {
  if (file.name.size() > 100) throw std::invalid_argument("name too long for a tar archive: " + file.name);
  TarHeader header{};
  put(header, 0, file.name);
  put(header, 100, "0000644");
  put(header, 108, "0000000");
  put(header, 116, "0000000");
  put(header, 124, octal(file.bytes.size(), 11));
  put(header, 136, "00000000000");
  put(header, 148, "        ");  // counted as spaces in the checksum
  put(header, 156, "0");
  put(header, 257, std::string_view("ustar\00000", 8));
  const auto add = [](std::size_t sum, char c) { return sum + static_cast<unsigned char>(c); };
  put(header, 148, octal(std::accumulate(header.begin(), header.end(), std::size_t{0}, add), 6));
  header[154] = '\0';
  return header;
}

}  // namespace

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written; check folder and free space");
}

void write_files(const std::filesystem::path& folder, const std::vector<ExportedFile>& files) {
  for (const ExportedFile& file : files) {
    const std::filesystem::path path = folder / file.name;
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) throw std::runtime_error(path.parent_path().string() + ": cannot be made: " + error.message());
    write_file(path, file.bytes);
  }
}

void remove_numbered_from(const std::filesystem::path& folder, const std::string& stem,
                          const std::string& extension, int first) {
  std::vector<std::filesystem::path> stale;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    int number = 0;
    std::from_chars(name.data() + std::min(stem.size(), name.size()), name.data() + name.size(), number);
    if (number >= first && name == stem + std::to_string(number) + extension) stale.push_back(entry.path());
  }
  for (const auto& file : stale) std::filesystem::remove(file, error);
}

std::string tar_of(const std::vector<ExportedFile>& files) {
  std::string archive;
  for (const ExportedFile& file : files) {
    const TarHeader header = tar_header(file);
    archive.append(header.data(), header.size()).append(file.bytes);
    archive.append((kTarBlock - file.bytes.size() % kTarBlock) % kTarBlock, '\0');
  }
  return archive.append(2 * kTarBlock, '\0');
}

std::string shortest_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace flogmap
