#include "tests/server/raw_stream.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>

namespace flogmap {

namespace net = boost::asio;
using tcp = net::ip::tcp;

struct RawConnection::Socket {
  net::io_context io;
  tcp::socket socket{io};
  std::string buffer;
  bool ended = false;

  /// Takes in what comes next; false once the other side has closed or 10 s have passed.
  bool take_in() {
    std::string part(16384, '\0');
    std::size_t size = 0;
    bool done = false;
    socket.async_read_some(net::buffer(part), [&](boost::system::error_code error, std::size_t num_bytes) {
      done = true;
      ended = static_cast<bool>(error);
      size = num_bytes;
    });
    io.restart();
    io.run_for(std::chrono::seconds(10));
    if (!done) {
      ended = true;
      socket.cancel();
      io.run();
    }
    buffer.append(part, 0, size);
    return !ended;
  }
  std::string cut(std::size_t size) {
    std::string front = buffer.substr(0, size);
    buffer.erase(0, size);
    return front;
  }
};

RawConnection::RawConnection(std::uint16_t port) : socket_(std::make_unique<Socket>()) {
  socket_->socket.connect({net::ip::address_v4::loopback(), port});
  socket_->socket.set_option(tcp::no_delay(true));
}

RawConnection::~RawConnection() = default;

bool RawConnection::send(const std::string& bytes) {
  boost::system::error_code error;
  net::write(socket_->socket, net::buffer(bytes), error);
  return !error;
}

std::string RawConnection::read_until(const std::string& mark) {
  for (;;) {
    const auto found = socket_->buffer.find(mark);
    if (found != std::string::npos) return socket_->cut(found + mark.size());
    if (socket_->ended || !socket_->take_in()) return socket_->cut(socket_->buffer.size());
  }
}

std::string RawConnection::read(std::size_t size) {
  while (socket_->buffer.size() < size && !socket_->ended) socket_->take_in();
  return socket_->cut(size);
}

std::string RawConnection::read_to_end() {
  while (!socket_->ended) socket_->take_in();
  return socket_->cut(socket_->buffer.size());
}

void RawConnection::reset() {
  boost::system::error_code ignored;
  socket_->socket.set_option(net::socket_base::linger(true, 0), ignored);
  socket_->socket.close(ignored);
}

std::string bytes_of(const RawFrame& frame) {
  const std::uint64_t size = frame.claimed_size == UINT64_MAX ? frame.payload.size() : frame.claimed_size;
  std::string bytes(1, static_cast<char>(frame.first));
  const auto mask_bit = static_cast<std::uint8_t>(frame.masked ? 0x80 : 0);
  const int more = size < 126 ? 0 : size < 65536 ? 2 : 8;
  const auto first_size = more == 0 ? static_cast<std::uint8_t>(size) : more == 2 ? 126 : 127;
  bytes += static_cast<char>(mask_bit | first_size);
  for (int i = more - 1; i >= 0; --i) bytes += static_cast<char>((size >> (8 * i)) & 0xffU);
  if (frame.masked) bytes += std::string(4, '\0');  // a mask of zeros changes nothing
  return bytes + frame.payload;
}

std::string upgrade_request(std::uint16_t port) {
  return "GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: flogmap.v1.proto\r\n\r\n";
}

int close_code_after(std::uint16_t port, const std::string& frames) {
  RawConnection connection(port);
  connection.send(upgrade_request(port));
  if (!connection.read_until("\r\n\r\n").starts_with("HTTP/1.1 101")) return -1;
  connection.send(frames);
  for (;;) {  // server frames are not masked
    const std::string head = connection.read(2);
    if (head.size() < 2) return 0;
    std::uint64_t size = static_cast<std::uint8_t>(head[1]);
    if (size >= 126) {
      const std::string more = connection.read(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : more) size = size << 8U | static_cast<std::uint8_t>(c);
    }
    const std::string payload = connection.read(size);
    const bool closes = (static_cast<std::uint8_t>(head[0]) & 0x0fU) == 8;
    if (closes && payload.size() >= 2)
      return static_cast<std::uint8_t>(payload[0]) * 256 + static_cast<std::uint8_t>(payload[1]);
    if (closes || payload.size() < size) return 0;
  }
}

}  // namespace flogmap
