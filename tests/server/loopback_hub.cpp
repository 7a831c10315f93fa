#include "tests/server/loopback_hub.hpp"

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http_ = boost::beast::http;
namespace websocket = boost::beast::websocket;
using tcp = net::ip::tcp;

namespace {

tcp::endpoint endpoint_of(std::uint16_t port) { return {net::ip::address_v4::loopback(), port}; }

}  // namespace

LoopbackHub::LoopbackHub(ServeOptions options) {
  options.port = 0;
  HubInfo info;
  info.version = "test";
  info.config_json = R"({"cell-size":{"value":0.02,"from":"default"}})";
  hub_ = std::make_unique<Hub>(options, session_, info);
  thread_ = std::thread([this] { hub_->run(); });
}

LoopbackHub::~LoopbackHub() {
  hub_->drain("the test is over");
  if (thread_.joinable()) thread_.join();
}

HttpReply http(std::uint16_t port, const std::string& method, const std::string& target,
               const HttpHeaders& headers, const std::string& body) {
  net::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(endpoint_of(port));
  http_::request<http_::string_body> request;
  request.method_string(method);
  request.target(target);
  request.version(11);
  request.set(http_::field::host, "127.0.0.1:" + std::to_string(port));
  for (const auto& [name, value] : headers) request.set(name, value);
  request.body() = body;
  request.prepare_payload();
  beast::error_code error;
  http_::write(stream, request, error);
  beast::flat_buffer buffer;
  http_::response_parser<http_::string_body> parser;
  parser.body_limit(64U << 20U);
  parser.skip(method == "HEAD");
  http_::read(stream, buffer, parser, error);
  if (!parser.is_header_done()) return {};
  HttpReply reply{static_cast<int>(parser.get().result_int()), {}, parser.get().body()};
  for (const auto& field : parser.get()) {
    std::string name(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    reply.headers[name] = std::string(field.value());
  }
  return reply;
}

std::string raw(std::uint16_t port, const std::string& bytes) {
  net::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(endpoint_of(port));
  beast::error_code error;
  net::write(stream, net::buffer(bytes), error);
  std::string all;
  stream.expires_after(std::chrono::seconds(5));
  for (std::string part(4096, '\0'); !error;) {
    std::size_t size = 0;
    stream.async_read_some(net::buffer(part), [&](beast::error_code read_error, std::size_t num_bytes) {
      error = read_error;
      size = num_bytes;
    });
    io.restart();
    io.run();
    all.append(part, 0, size);
  }
  return all;
}

struct StreamClient::Socket {
  net::io_context io;
  websocket::stream<beast::tcp_stream> stream{io};
  beast::flat_buffer buffer;
  bool reading = false;
  bool done = false;
  beast::error_code error;
};

StreamClient::StreamClient(std::uint16_t port, const Options& options) : socket_(std::make_unique<Socket>()) {
  auto& stream = socket_->stream;
  auto& lowest = beast::get_lowest_layer(stream);
  lowest.socket().open(tcp::v4());
  if (options.receive_buffer_bytes > 0) {
    lowest.socket().set_option(net::socket_base::receive_buffer_size(options.receive_buffer_bytes));
  }
  lowest.connect(endpoint_of(port));
  stream.read_message_max(64U << 20U);
  stream.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
    request.set(http_::field::sec_websocket_protocol, "flogmap.v1.proto");
  }));
  stream.handshake("127.0.0.1:" + std::to_string(port), "/api/v1/stream");
}

StreamClient::~StreamClient() = default;

void StreamClient::send(const std::string& bytes, bool binary) {
  socket_->stream.binary(binary);
  beast::error_code ignored;
  socket_->stream.write(net::buffer(bytes), ignored);
}

std::optional<std::string> StreamClient::read(std::chrono::milliseconds patience) {
  Socket& socket = *socket_;
  if (socket.error) return std::nullopt;
  if (!socket.reading) {
    socket.reading = true;
    socket.done = false;
    socket.stream.async_read(socket.buffer, [&socket](beast::error_code error, std::size_t) {
      socket.error = error;
      socket.done = true;
      socket.reading = false;
    });
  }
  socket.io.restart();
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!socket.done && std::chrono::steady_clock::now() < deadline) socket.io.run_one_until(deadline);
  if (!socket.done || socket.error) return std::nullopt;
  std::string message = beast::buffers_to_string(socket.buffer.data());
  socket.buffer.consume(socket.buffer.size());
  return message;
}

int StreamClient::wait_for_close(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!socket_->error && std::chrono::steady_clock::now() < deadline) {
    read(std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()));
  }
  return close_code();
}

int StreamClient::close_code() const {
  return socket_->error == websocket::error::closed ? socket_->stream.reason().code : 0;
}

}  // namespace flogmap
