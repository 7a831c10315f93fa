#include "tests/bench/serve_fetch.hpp"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <thread>
#include <vector>

#include "tests/bench/quantile.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/raw_stream.hpp"

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http_ = boost::beast::http;
using std::chrono::steady_clock;
using tcp = net::ip::tcp;

namespace {

/// What all connections ask, and what they saw.
struct Exchange {
  std::string request;
  std::size_t answer_bytes = 0;
  steady_clock::duration interval{0};  // between the requests of one connection; 0: none
  std::vector<double> times_ms{};
};

/// One keep-alive connection that asks again as soon as it is answered, or when it is time.
class Fetcher : public std::enable_shared_from_this<Fetcher> {
 public:
  Fetcher(net::io_context& io, Exchange& exchange)
      : socket_(io), timer_(io), exchange_(exchange), answer_(exchange.answer_bytes, char{}) {}

  void start(std::uint16_t port, steady_clock::time_point first) {
    socket_.connect({net::ip::address_v4::loopback(), port});
    socket_.set_option(tcp::no_delay(true));
    due_ = first;
    wait();
  }

 private:
  void wait() {
    if (exchange_.interval.count() == 0) {
      due_ = steady_clock::now();
      return ask();
    }
    timer_.expires_at(due_);
    timer_.async_wait([self = shared_from_this()](beast::error_code error) {
      if (!error) self->ask();
    });
  }
  void ask() {
    net::async_write(socket_, net::buffer(exchange_.request),
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->hear();
                     });
  }
  void hear() {
    net::async_read(socket_, net::buffer(answer_),
                    [self = shared_from_this()](beast::error_code error, std::size_t) {
                      if (error) return;
                      // From when it was due, not from when there was time to ask.
                      const std::chrono::duration<double, std::milli> took = steady_clock::now() - self->due_;
                      self->exchange_.times_ms.push_back(took.count());
                      self->due_ += self->exchange_.interval;
                      self->wait();
                    });
  }

  tcp::socket socket_;
  net::steady_timer timer_;
  Exchange& exchange_;
  std::vector<char> answer_;
  steady_clock::time_point due_;
};

std::size_t answer_size(std::uint16_t port, const std::string& request) {
  RawConnection connection(port);
  connection.send(request);
  const std::string head = connection.read_until("\r\n\r\n");
  const auto at = head.find("Content-Length: ");
  return head.size() + (at == std::string::npos ? 0 : std::stoul(head.substr(at + 16)));
}

}  // namespace

nlohmann::json fetch(std::uint16_t port, const FetchLoad& load, std::chrono::seconds duration) {
  Exchange exchange;
  exchange.request = "GET " + load.target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n";
  if (load.conditional) {
    exchange.request += "If-None-Match: " + http(port, "GET", load.target).headers.at("etag") + "\r\n";
  }
  exchange.request += "\r\n";
  exchange.answer_bytes = answer_size(port, exchange.request);
  if (load.per_s > 0) {
    const std::chrono::duration<double> interval(load.connections / load.per_s);
    exchange.interval = std::chrono::duration_cast<steady_clock::duration>(interval);
  }
  net::io_context io{1};
  const auto start = steady_clock::now();
  for (int i = 0; i < load.connections; ++i) {
    std::make_shared<Fetcher>(io, exchange)->start(port, start + exchange.interval * i / load.connections);
  }
  io.run_for(duration);
  return {{"per_s", static_cast<double>(exchange.times_ms.size()) / static_cast<double>(duration.count())},
          {"p50_ms", quantile(exchange.times_ms, 0.5)},
          {"p99_ms", quantile(exchange.times_ms, 0.99)}};
}

std::string a_tile_target(std::uint16_t port) {
  const auto changes = nlohmann::json::parse(http(port, "GET", "/api/v1/maps/live/changes").body);
  for (const auto& tile : changes["tiles"]) {
    if (tile["level"] != 0) continue;
    return "/api/v1/maps/live/layers/fused/tiles/0/" + tile["x"].dump() + "/" + tile["y"].dump();
  }
  throw std::runtime_error("the map has no tile");
}

nlohmann::json beside_slow_ones(std::uint16_t port, const std::string& target) {
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 200; ++i) {
    slow.push_back(std::make_unique<RawConnection>(port));
    slow.back()->send("GET / HTTP/1.1\r\nX-Slow: ");
  }
  std::vector<double> times_ms;
  for (int round = 0; round < 150; ++round) {
    for (const auto& one : slow) one->send("a");
    const auto start = steady_clock::now();
    http(port, "GET", target);
    times_ms.push_back(std::chrono::duration<double, std::milli>(steady_clock::now() - start).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return {{"slowloris_median_ms", quantile(times_ms, 0.5)}, {"slowloris_max_ms", quantile(times_ms, 1)}};
}

struct BareServer::Parts {
  net::io_context io{1};
  tcp::acceptor acceptor{io, {net::ip::address_v4::loopback(), 0}};
  std::thread thread;

  struct Session : std::enable_shared_from_this<Session> {
    explicit Session(tcp::socket socket) : stream(std::move(socket)) {}
    void read() {
      request = {};
      http_::async_read(stream, buffer, request,
                        [self = shared_from_this()](beast::error_code error, std::size_t) {
                          if (!error) self->write();
                        });
    }
    void write() {
      response = {http_::status::ok, 11};
      response.set(http_::field::content_type, "text/plain");
      response.body() = "hello world\n";
      response.prepare_payload();
      http_::async_write(stream, response, [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (!error) self->read();
      });
    }
    beast::tcp_stream stream;
    beast::flat_buffer buffer;
    http_::request<http_::string_body> request;
    http_::response<http_::string_body> response;
  };

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error) return;
      socket.set_option(tcp::no_delay(true));
      std::make_shared<Session>(std::move(socket))->read();
      accept();
    });
  }
};

BareServer::BareServer() : parts_(std::make_unique<Parts>()) {
  parts_->accept();
  parts_->thread = std::thread([this] { parts_->io.run(); });
}

BareServer::~BareServer() {
  parts_->io.stop();
  parts_->thread.join();
}

std::uint16_t BareServer::port() const { return parts_->acceptor.local_endpoint().port(); }

}  // namespace flogmap
