#include "server/listener.hpp"

#include <openssl/ssl.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/http_session.hpp"
#include "server/log.hpp"
#include "server/response_head.hpp"

namespace flogmap {

namespace net = boost::asio;
using boost::system::error_code;
using tcp = net::ip::tcp;

namespace {

constexpr std::chrono::seconds kComplainEvery{10};

[[noreturn]] void refuse_tls_file(const std::string& option, const std::string& file,
                                  const std::string& wanted) {
  const bool readable = std::ifstream(file).good();
  throw std::invalid_argument("--" + option + " " + file +
                              (readable ? " is not " + wanted : ": no such file, or it cannot be read"));
}

net::ssl::context tls_context(const ServeOptions& options) {
  net::ssl::context tls(net::ssl::context::tls_server);
  tls.set_options(net::ssl::context::default_workarounds | net::ssl::context::no_compression);
  SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_2_VERSION);
  error_code error;
  tls.use_certificate_chain_file(options.tls_cert, error);
  if (error) refuse_tls_file("tls-cert", options.tls_cert, "a PEM certificate");
  tls.use_private_key_file(options.tls_key, net::ssl::context::pem, error);
  if (error) refuse_tls_file("tls-key", options.tls_key, "the PEM private key of " + options.tls_cert);
  return tls;
}

std::string shown(const tcp::endpoint& endpoint) {
  const std::string address = endpoint.address().to_string();
  const bool v6 = endpoint.address().is_v6();
  return (v6 ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port());
}

/// An address as people write it: IPv4 also where the socket maps it into IPv6.
std::string plain_address(const net::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

}  // namespace

void check_tls(const ServeOptions& options) {
  if (!options.tls_cert.empty()) (void)tls_context(options);
}

Listener::Listener(net::io_context& network, const ServeOptions& options, SessionContext context,
                   ConnectionLimit& limit)
    : acceptor_(network), pause_(network), context_(context), limit_(limit) {
  if (!options.tls_cert.empty()) tls_.emplace(tls_context(options));
  const tcp::endpoint endpoint(net::ip::make_address(options.listen_address), options.port);
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  error_code error;
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (error == net::error::address_in_use) {
    throw std::runtime_error(shown(endpoint) + " is in use; choose another with --listen");
  }
  if (error) throw std::runtime_error("cannot listen on " + shown(endpoint) + ": " + error.message());
  port_ = acceptor_.local_endpoint().port();
}

void Listener::start() { accept(); }

void Listener::stop() {
  error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel();
}

void Listener::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error) {
      welcome(std::move(socket));
      return accept();
    }
    // Too many open files, for instance: wait for some to close instead of spinning.
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void Listener::welcome(tcp::socket socket) {
  error_code error;
  const tcp::endpoint remote = socket.remote_endpoint(error), local = socket.local_endpoint(error);
  if (error) return;  // gone already
  Peer peer{plain_address(remote.address()), plain_address(local.address()), nullptr};
  peer.ticket = limit_.admit(peer.remote_address);
  if (!peer.ticket) return turn_away(std::move(socket), peer.remote_address);
  socket.set_option(tcp::no_delay(true), error);
  PlainStream stream(std::move(socket));
  if (tls_) {
    std::make_shared<HttpSession<TlsStream>>(TlsStream(std::move(stream), *tls_), context_, std::move(peer))
        ->run();
  } else {
    std::make_shared<HttpSession<PlainStream>>(std::move(stream), context_, std::move(peer))->run();
  }
}

void Listener::turn_away(tcp::socket socket, const std::string& remote_address) {
  context_.state.metrics.count_refused_connection();
  const auto now = std::chrono::steady_clock::now();
  if (now - complained_at_ > kComplainEvery) {
    complained_at_ = now;
    log_event(LogLevel::warning, "connections are turned away",
              {{"remote", remote_address}, {"open", std::int64_t{limit_.num_open()}}});
  }
  if (tls_) return;
  auto message = std::make_shared<const std::string>(refused_connection());
  auto held = std::make_shared<tcp::socket>(std::move(socket));
  net::async_write(*held, net::buffer(*message), [held, message](error_code, std::size_t) {
    error_code ignored;
    held->shutdown(tcp::socket::shutdown_both, ignored);
  });
}

}  // namespace flogmap
