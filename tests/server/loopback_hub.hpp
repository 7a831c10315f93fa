#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/hub.hpp"
#include "tests/server/fake_session.hpp"

namespace flogmap {

/// A real hub on a free loopback port, in a thread of its own, until the end of the scope.
class LoopbackHub {
 public:
  explicit LoopbackHub(ServeOptions options = {});
  ~LoopbackHub();

  [[nodiscard]] Hub& hub() { return *hub_; }
  [[nodiscard]] FakeSession& session() { return session_; }
  [[nodiscard]] std::uint16_t port() const { return hub_->port(); }
  /// Waits until run() has returned.
  void join() { thread_.join(); }

 private:
  FakeSession session_;
  std::unique_ptr<Hub> hub_;
  std::thread thread_;
};

struct HttpReply {
  int status = 0;                              // 0: the connection was closed without an answer
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

using HttpHeaders = std::vector<std::pair<std::string, std::string>>;

/// One request on a connection of its own.
HttpReply http(std::uint16_t port, const std::string& method, const std::string& target,
               const HttpHeaders& headers = {}, const std::string& body = {});

/// Sends bytes as they are and returns all that comes back until the server closes (or 5 s pass).
std::string raw(std::uint16_t port, const std::string& bytes);

/// A WebSocket client that waits with a deadline.
class StreamClient {
 public:
  struct Options {
    int receive_buffer_bytes = 0;  // 0: as the system likes
  };

  /// Throws std::runtime_error if the server does not open the stream.
  explicit StreamClient(std::uint16_t port) : StreamClient(port, Options{}) {}
  StreamClient(std::uint16_t port, const Options& options);
  ~StreamClient();

  void send(const std::string& bytes, bool binary = true);
  /// The next message; nothing if none comes in time or the stream was closed.
  std::optional<std::string> read(std::chrono::milliseconds patience = std::chrono::seconds(5));
  /// Reads until the server closes; its close code, 0 if it does not close in time.
  int wait_for_close(std::chrono::milliseconds patience = std::chrono::seconds(8));
  [[nodiscard]] int close_code() const;

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace flogmap
