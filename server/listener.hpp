#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <optional>

#include "server/session_context.hpp"

namespace flogmap {

/// Throws std::invalid_argument in one line if the files of a certificate and its key cannot be used
/// together.
void check_tls(const ServeOptions& options);

/// Accepts connections, within the limits.
class Listener {
 public:
  /// Binds. Throws in one line if that fails (std::runtime_error) or the certificate cannot be used
  /// (std::invalid_argument).
  Listener(boost::asio::io_context& network, const ServeOptions& options, SessionContext context,
           ConnectionLimit& limit);

  void start();
  void stop();
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void accept();
  void welcome(boost::asio::ip::tcp::socket socket);
  void turn_away(boost::asio::ip::tcp::socket socket, const std::string& remote_address);

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::optional<boost::asio::ssl::context> tls_;
  SessionContext context_;
  ConnectionLimit& limit_;
  std::chrono::steady_clock::time_point complained_at_;
  std::uint16_t port_ = 0;
};

}  // namespace flogmap
