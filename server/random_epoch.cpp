#include "server/random_epoch.hpp"

#include <random>

namespace flogmap {

std::string random_epoch() {
  std::random_device random;
  static constexpr const char* kDigits = "0123456789abcdef";
  std::string epoch;
  for (int i = 0; i < 16; ++i) epoch += kDigits[random() & 15U];
  return epoch;
}

}  // namespace flogmap
