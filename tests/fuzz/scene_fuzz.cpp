// A scene's JSON is taken or refused with std::runtime_error.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "camera/simulation/scene_json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)flogmap::parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.json", "/nonexistent");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
