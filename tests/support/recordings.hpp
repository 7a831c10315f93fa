#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace flogmap {

/// A recording with ground truth in the folder that FLOGMAP_DATA names; nothing if it is unset or lacks it.
inline std::optional<std::filesystem::path> recording(const std::string& name) {
  const char* data = std::getenv("FLOGMAP_DATA");
  if (data == nullptr) return std::nullopt;
  const std::filesystem::path folder = std::filesystem::path(data) / name;
  if (!std::filesystem::exists(folder)) return std::nullopt;
  return folder;
}

}  // namespace flogmap
