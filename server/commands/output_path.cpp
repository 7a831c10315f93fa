#include "server/commands/output_path.hpp"

#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "server/option_table.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw UsageError("--out " + path.string() + ": " + why);
}

void require_writable(const fs::path& there, const fs::path& asked) {
  if (::access(there.c_str(), W_OK) != 0)
    refuse(asked, "cannot be written: " + std::system_category().message(errno));
}

}  // namespace

void check_output_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) refuse(file, "is a folder; name a file");
  if (fs::exists(file, error)) return require_writable(file, file);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!fs::is_directory(folder, error)) refuse(file, "there is no folder " + folder.string());
  require_writable(folder, file);
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    refuse(folder, "is a file; name a folder");
  fs::create_directories(folder, error);
  if (error) refuse(folder, "cannot be made: " + error.message());
  require_writable(folder, folder);
}

}  // namespace flogmap
