// Where a command writes to, checked before it begins: a name that cannot be is bad input, not a failure.
#pragma once

#include <filesystem>

namespace flogmap {

/// Throws UsageError if no file of this name can be written: its folder is not there, it is a folder itself,
/// or permission is missing.
void check_output_file(const std::filesystem::path& file);

/// Makes the folder and those above it; throws UsageError if it cannot be made or written to.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace flogmap
