#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace flogmap {

/// A TCP connection to the loopback address that sends any bytes whatever, with a deadline of 10 s.
class RawConnection {
 public:
  explicit RawConnection(std::uint16_t port);
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  /// False if the other side has gone.
  bool send(const std::string& bytes);
  /// Everything until this text has come (it included), or until the other side closes.
  std::string read_until(const std::string& mark);
  /// Exactly so many bytes, or fewer if the other side closes.
  std::string read(std::size_t size);
  std::string read_to_end();
  /// Closes by a reset (RST) instead of a proper end.
  void reset();

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

/// A WebSocket frame of a client: masked unless told otherwise, all bits as they are given.
struct RawFrame {
  std::uint8_t first = 0x82;  // FIN, reserved bits, opcode
  std::string payload{};
  bool masked = true;
  std::uint64_t claimed_size = UINT64_MAX;  // UINT64_MAX: the true one
};
std::string bytes_of(const RawFrame& frame);

/// The request that opens the stream.
std::string upgrade_request(std::uint16_t port);

/// Sends raw frames on a freshly opened stream and returns the code that the server closes with; 0 if it
/// closes without one, -1 if the stream did not open.
int close_code_after(std::uint16_t port, const std::string& frames);

}  // namespace flogmap
