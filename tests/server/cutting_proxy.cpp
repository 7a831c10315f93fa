#include "tests/server/cutting_proxy.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <thread>

namespace flogmap {

namespace net = boost::asio;
using boost::system::error_code;
using tcp = net::ip::tcp;

namespace {

/// One connection: bytes go to and fro until the weather ends it.
class Line : public std::enable_shared_from_this<Line> {
 public:
  Line(tcp::socket client, tcp::socket server, const Weather& weather)
      : client_(std::move(client)), server_(std::move(server)), weather_(weather) {}

  void start() {
    up();
    down();
  }

 private:
  void up() {
    client_.async_read_some(
        net::buffer(to_server_), [self = shared_from_this()](error_code error, std::size_t size) {
          if (error) return self->cut();
          net::async_write(self->server_, net::buffer(self->to_server_, size),
                           [self](error_code failed, std::size_t) { failed ? self->cut() : self->up(); });
        });
  }

  void down() {
    server_.async_read_some(net::buffer(to_client_),
                            [self = shared_from_this()](error_code error, std::size_t size) {
                              if (error) return self->cut();
                              self->pass_on(size);
                            });
  }

  void pass_on(std::size_t size) {
    const std::uint64_t most = std::min(weather_.cut_after_bytes, weather_.stall_after_bytes);
    const auto allowed = static_cast<std::size_t>(std::min<std::uint64_t>(size, most - passed_));
    passed_ += allowed;
    net::async_write(client_, net::buffer(to_client_, allowed),
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (error || self->passed_ >= self->weather_.cut_after_bytes) return self->cut();
                       if (self->passed_ < self->weather_.stall_after_bytes) self->down();
                     });
  }

  void cut() {
    for (tcp::socket* socket : {&client_, &server_}) {
      error_code ignored;
      socket->set_option(net::socket_base::linger(true, 0), ignored);
      socket->close(ignored);
    }
  }

  tcp::socket client_, server_;
  Weather weather_;
  std::uint64_t passed_ = 0;
  std::array<char, 4096> to_server_{}, to_client_{};
};

}  // namespace

struct CuttingProxy::Parts {
  explicit Parts(std::uint16_t port) : server_port(port) {}

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket client) {
      if (error) return;
      tcp::socket server(io);
      error_code failed;
      server.connect({net::ip::address_v4::loopback(), server_port}, failed);
      if (!failed) std::make_shared<Line>(std::move(client), std::move(server), weather)->start();
      accept();
    });
  }

  std::uint16_t server_port;
  net::io_context io{1};
  tcp::acceptor acceptor{io, {net::ip::address_v4::loopback(), 0}};
  Weather weather;
  std::thread thread;
};

CuttingProxy::CuttingProxy(std::uint16_t server_port) : parts_(std::make_unique<Parts>(server_port)) {
  parts_->accept();
  parts_->thread = std::thread([this] { parts_->io.run(); });
}

CuttingProxy::~CuttingProxy() {
  parts_->io.stop();
  parts_->thread.join();
}

std::uint16_t CuttingProxy::port() const { return parts_->acceptor.local_endpoint().port(); }

void CuttingProxy::set(const Weather& weather) {
  net::post(parts_->io, [this, weather] { parts_->weather = weather; });
}

}  // namespace flogmap
