#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flogmap {

/// A finished file that has not been written yet; `name` may hold folders, as "ros/map.pgm".
struct ExportedFile {
  std::string name;
  std::string content_type;
  std::string bytes;
};

/// Writes them below a folder, which is made if missing. Throws std::runtime_error naming the file.
void write_files(const std::filesystem::path& folder, const std::vector<ExportedFile>& files);
void write_file(const std::filesystem::path& path, const std::string& bytes);

/// Removes `stem`<number>`extension` of a folder from number `first` on, as an older map with more layers has
/// left them; nothing else.
void remove_numbered_from(const std::filesystem::path& folder, const std::string& stem,
                          const std::string& extension, int first);

/// All of them as one POSIX tar archive (ustar); names up to 100 bytes.
std::string tar_of(const std::vector<ExportedFile>& files);

/// The shortest decimal text that reads back as the same number.
std::string shortest_text(double value);

}  // namespace flogmap
