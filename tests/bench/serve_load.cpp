#include "tests/bench/serve_load.hpp"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <thread>
#include <vector>

#include "flogmap/v1/stream.pb.h"
#include "tests/bench/quantile.hpp"
#include "tests/server/client_frames.hpp"

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http_ = boost::beast::http;
namespace websocket = boost::beast::websocket;
using std::chrono::steady_clock;

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
  }
  void follow() { read(); }
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
    viewers.back()->follow();
  }
  ages_ms.clear();
  io.run_for(duration);
  const auto served =
      std::count_if(viewers.begin(), viewers.end(), [](const auto& viewer) { return viewer->served(); });
  return {{"pose_p50_ms", quantile(ages_ms, 0.5)},
          {"pose_p99_ms", quantile(ages_ms, 0.99)},
          {"viewers_served", served}};
}

nlohmann::json stall(std::uint16_t port, int count, std::chrono::seconds duration) {
  net::io_context io{1};
  std::vector<double> none;
  std::vector<std::shared_ptr<LoadViewer>> viewers;
  for (int i = 0; i < count; ++i) {
    viewers.push_back(std::make_shared<LoadViewer>(io, none));
    viewers.back()->start(port);
  }
  std::this_thread::sleep_for(duration);
  return nlohmann::json::object();
}

}  // namespace flogmap
