#pragma once

#include <cstdint>
#include <memory>

namespace flogmap {

/// What happens to the connections that come through a CuttingProxy from now on.
struct Weather {
  std::uint64_t cut_after_bytes = UINT64_MAX;  // from the server: then both ends are reset, in mid-message
  std::uint64_t stall_after_bytes =
      UINT64_MAX;  // from the server: then nothing more is passed on, both stay open
};

/// A bad network between a client and a server on the loopback address.
class CuttingProxy {
 public:
  explicit CuttingProxy(std::uint16_t server_port);
  ~CuttingProxy();
  CuttingProxy(const CuttingProxy&) = delete;
  CuttingProxy& operator=(const CuttingProxy&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  void set(const Weather& weather);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flogmap
