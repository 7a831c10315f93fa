#include "tests/bench/serve_load.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <thread>
#include <vector>

#include "flogmap/v1/stream.pb.h"
#include "tests/server/client_frames.hpp"
#include "tests/server/loopback_hub.hpp"

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http_ = boost::beast::http;
namespace websocket = boost::beast::websocket;
using std::chrono::steady_clock;
using tcp = net::ip::tcp;

namespace {

/// Follows the stream on a shared io_context.
class LoadViewer : public std::enable_shared_from_this<LoadViewer> {
 public:
  LoadViewer(net::io_context& io, std::vector<double>& ages_ms) : stream_(io), ages_ms_(ages_ms) {}

  void start(std::uint16_t port) {
    beast::get_lowest_layer(stream_).connect({net::ip::address_v4::loopback(), port});
    beast::get_lowest_layer(stream_).expires_never();
    stream_.read_message_max(16U << 20U);
    stream_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http_::field::sec_websocket_protocol, "flogmap.v1.proto");
    }));
    stream_.handshake("127.0.0.1:" + std::to_string(port), "/api/v1/stream");
    stream_.binary(true);
    stream_.write(net::buffer(hello_frame()));
    stream_.write(net::buffer(subscribe_frame({{{}, Planes::evidence}, {}, 20, false})));
    read();
  }
  [[nodiscard]] bool served() const { return num_poses_ > 0; }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t size) {
      if (error) return;
      self->take(size);
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void take(std::size_t size) {
    // The field number of the oneof stands in the first byte; parsing every tile would load the client, not
    // the server.
    const auto* bytes = static_cast<const char*>(buffer_.data().data());
    const int field = static_cast<unsigned char>(bytes[0]) >> 3U;
    if (field == v1::ServerMessage::kTileBatchFieldNumber) {
      acknowledged_ += size;
      frame_ = ack_frame(acknowledged_);
      beast::error_code ignored;
      stream_.write(net::buffer(frame_), ignored);
    } else if (field == v1::ServerMessage::kPoseFieldNumber) {
      v1::ServerMessage message;
      message.ParseFromArray(bytes, static_cast<int>(size));
      ages_ms_.push_back(static_cast<double>(wall_ns() - message.pose().time_ns()) / 1e6);
      ++num_poses_;
    }
  }

  websocket::stream<beast::tcp_stream> stream_;
  std::vector<double>& ages_ms_;
  beast::flat_buffer buffer_;
  std::string frame_;
  std::uint64_t acknowledged_ = 0;
  int num_poses_ = 0;
};

/// One keep-alive connection that asks again as soon as it is answered.
class Fetcher : public std::enable_shared_from_this<Fetcher> {
 public:
  Fetcher(net::io_context& io, std::string request, std::int64_t& count)
      : stream_(io), request_(std::move(request)), count_(count) {}

  void start(std::uint16_t port) {
    stream_.connect({net::ip::address_v4::loopback(), port});
    stream_.socket().set_option(tcp::no_delay(true));
    stream_.expires_never();
    ask();
  }

 private:
  void ask() {
    net::async_write(stream_, net::buffer(request_),
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->hear();
                     });
  }
  void hear() {
    parser_.emplace();
    http_::async_read(stream_, buffer_, *parser_,
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (error) return;
                        ++self->count_;
                        self->ask();
                      });
  }

  beast::tcp_stream stream_;
  std::string request_;
  std::int64_t& count_;
  beast::flat_buffer buffer_;
  std::optional<http_::response_parser<http_::string_body>> parser_;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

nlohmann::json watch(std::uint16_t port, int count, std::chrono::seconds duration) {
  net::io_context io{1};
  std::vector<double> ages_ms;
  std::vector<std::shared_ptr<LoadViewer>> viewers;
  for (int i = 0; i < count; ++i) {
    viewers.push_back(std::make_shared<LoadViewer>(io, ages_ms));
    viewers.back()->start(port);
  }
  ages_ms.clear();
  io.run_for(duration);
  const auto served =
      std::count_if(viewers.begin(), viewers.end(), [](const auto& viewer) { return viewer->served(); });
  return {{"pose_p50_ms", quantile(ages_ms, 0.5)},
          {"pose_p99_ms", quantile(ages_ms, 0.99)},
          {"viewers_served", served}};
}

nlohmann::json fetch(std::uint16_t port, const std::string& target, bool conditional,
                     std::chrono::seconds duration) {
  std::string request = "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n";
  if (conditional) request += "If-None-Match: " + http(port, "GET", target).headers.at("etag") + "\r\n";
  request += "\r\n";
  net::io_context io{1};
  std::int64_t count = 0;
  for (int i = 0; i < 8; ++i) std::make_shared<Fetcher>(io, request, count)->start(port);
  io.run_for(duration);
  return {{"per_s", static_cast<double>(count) / static_cast<double>(duration.count())}};
}

std::string a_tile_target(std::uint16_t port) {
  const auto changes = nlohmann::json::parse(http(port, "GET", "/api/v1/maps/live/changes").body);
  for (const auto& tile : changes["tiles"]) {
    if (tile["level"] != 0) continue;
    return "/api/v1/maps/live/layers/fused/tiles/0/" + tile["x"].dump() + "/" + tile["y"].dump();
  }
  throw std::runtime_error("the map has no tile");
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
