#include "server/store/checksum.hpp"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <stdexcept>

namespace flogmap {

LittleEndianBytes& LittleEndianBytes::add(std::uint64_t value) {
  for (int i = 0; i < 8; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  return *this;
}

LittleEndianBytes& LittleEndianBytes::add(double value) {
  return add(std::bit_cast<std::uint64_t>(value + 0.0));
}

std::uint64_t little_endian_u64(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

double little_endian_double(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<double>(little_endian_u64(bytes, at));
}

struct Sha256::Context {
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> evp{EVP_MD_CTX_new()};

  std::array<std::uint8_t, 32> finish() {
    std::array<std::uint8_t, 32> digest{};
    if (EVP_DigestFinal_ex(evp.get(), digest.data(), nullptr) != 1)
      throw std::runtime_error("SHA-256 failed");
    return digest;
  }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  if (!context_->evp || EVP_DigestInit_ex(context_->evp.get(), EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("OpenSSL offers no SHA-256");
  }
}

Sha256::~Sha256() = default;

Sha256& Sha256::add(std::span<const std::uint8_t> bytes) {
  EVP_DigestUpdate(context_->evp.get(), bytes.data(), bytes.size());
  return *this;
}

Sha256& Sha256::add(std::string_view text) {
  EVP_DigestUpdate(context_->evp.get(), text.data(), text.size());
  return *this;
}

std::string Sha256::hex() {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : context_->finish()) text += {kHex[byte >> 4], kHex[byte & 15]};
  return text;
}

std::uint64_t Sha256::number() { return little_endian_u64(context_->finish(), 0); }

}  // namespace flogmap
