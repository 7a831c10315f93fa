#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "camera/image.hpp"

namespace flogmap {

/// A picture read from a file, or why it could not be.
struct ReadPicture {
  Picture picture;
  std::string problem;  // empty if all went well; names the file
};

/// Reads PNG, JPEG, PGM and what else OpenCV reads; grey or colour, 8 or 16 bit, alpha dropped. Truncated
/// files are refused, not filled with grey.
[[nodiscard]] ReadPicture read_picture(const std::filesystem::path& file);

/// The same of a file's bytes; what is wrong with them comes without a name.
[[nodiscard]] ReadPicture decode_picture(const std::vector<std::uint8_t>& bytes);

/// Writes PNG (fast compression), PGM or JPEG by the name's extension. False where the file cannot be
/// written.
[[nodiscard]] bool write_picture(const std::filesystem::path& file, const Picture& picture);

}  // namespace flogmap
