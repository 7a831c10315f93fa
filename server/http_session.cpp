#include "server/http_session.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <utility>

#include "server/log.hpp"
#include "server/response_head.hpp"
#include "server/ws_session.hpp"

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using std::chrono::seconds;

namespace {

constexpr std::uint32_t kMaxHeaderBytes = 8U << 10U;
constexpr std::uint64_t kMaxBodyBytes = 64U << 10U;
constexpr std::size_t kMaxTargetBytes = 2U << 10U;
constexpr seconds kHeaderDeadline{5}, kBodyDeadline{10}, kWriteDeadline{10}, kIdleDeadline{60},
    kLingerDeadline{2};
constexpr int kMaxLingerReads = 64;
constexpr std::string_view kStreamPath = "/api/v1/stream";
constexpr std::string_view kStreamProtocol = "flogmap.v1.proto";

std::string text(boost::string_view view) { return {view.data(), view.size()}; }

Method method_of(http::verb verb) {
  switch (verb) {
    case http::verb::get:
      return Method::get;
    case http::verb::head:
      return Method::head;
    case http::verb::post:
      return Method::post;
    case http::verb::patch:
      return Method::patch;
    case http::verb::options:
      return Method::options;
    default:
      return Method::other;
  }
}

/// What RFC 6455 section 4.2.1 asks of a handshake, so that every refusal is ours.
template <typename Request>
bool opens_websocket(const Request& message) {
  constexpr std::size_t kKeyLength = 24;  // 16 bytes in base64
  const boost::string_view key = message[http::field::sec_websocket_key];
  return beast::websocket::is_upgrade(message) && message[http::field::sec_websocket_version] == "13" &&
         key.size() == kKeyLength && key.ends_with("==");
}

}  // namespace

template <typename Stream>
HttpSession<Stream>::HttpSession(Stream stream, SessionContext context, Peer peer)
    : stream_(std::move(stream)),
      context_(context),
      peer_(std::move(peer)),
      buffer_(kMaxHeaderBytes + kMaxBodyBytes) {}

template <typename Stream>
void HttpSession<Stream>::run() {
  if constexpr (std::is_same_v<Stream, TlsStream>) {
    beast::get_lowest_layer(stream_).expires_after(kHeaderDeadline);
    stream_.async_handshake(net::ssl::stream_base::server,
                            [self = this->shared_from_this()](ErrorCode error) {
                              if (!error) self->read_header();
                            });
  } else {
    read_header();
  }
}

/// Between requests a connection may rest; once something comes, the header deadline runs.
template <typename Stream>
void HttpSession<Stream>::wait_for_request() {
  if (buffer_.size() > 0) return read_header();
  beast::get_lowest_layer(stream_).expires_after(kIdleDeadline);
  constexpr std::size_t kRead = 2048;
  stream_.async_read_some(buffer_.prepare(kRead),
                          [self = this->shared_from_this()](ErrorCode error, std::size_t num_bytes) {
                            if (error) return;
                            self->buffer_.commit(num_bytes);
                            self->read_header();
                          });
}

template <typename Stream>
void HttpSession<Stream>::read_header() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  beast::get_lowest_layer(stream_).expires_after(kHeaderDeadline);
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = this->shared_from_this()](ErrorCode error, std::size_t) { self->on_header(error); });
}

template <typename Stream>
void HttpSession<Stream>::on_header(ErrorCode error) {
  if (error) {
    if (!refuse_early(error)) linger();
    return;
  }
  if (parser_->is_done()) return handle();
  beast::get_lowest_layer(stream_).expires_after(kBodyDeadline);
  http::async_read(
      stream_, buffer_, *parser_,
      [self = this->shared_from_this()](ErrorCode read_error, std::size_t) { self->on_body(read_error); });
}

template <typename Stream>
void HttpSession<Stream>::on_body(ErrorCode error) {
  if (!error) return handle();
  if (!refuse_early(error)) linger();
}

/// Answers a request that cannot be read; false if nobody is there to read the answer.
template <typename Stream>
bool HttpSession<Stream>::refuse_early(ErrorCode error) {
  const bool readable = error.category() == http::make_error_code(http::error::bad_method).category() &&
                        error != http::error::end_of_stream && error != http::error::partial_message;
  if (!readable) return false;
  ApiResponse response = problem(400, "bad-request", "this is no HTTP/1.1 request: " + error.message());
  if (error == http::error::body_limit) response = problem(413, "body-too-large", "at most 64 KiB");
  if (error == http::error::header_limit) {
    const bool url_is_long = parser_->get().target().empty();
    response = url_is_long ? problem(414, "url-too-long", "at most 2 KiB")
                           : problem(431, "header-too-large", "at most 8 KiB");
  }
  request_ = {};
  respond(std::move(response), false);
  return true;
}

template <typename Stream>
void HttpSession<Stream>::take_request_values() {
  auto& message = parser_->get();
  ApiRequest& request = request_ = {};
  request.method = method_of(message.method());
  request.accept = lower_case(text(message[http::field::accept]));
  request.accept_encoding = lower_case(text(message[http::field::accept_encoding]));
  request.if_none_match = text(message[http::field::if_none_match]);
  request.content_type = lower_case(text(message[http::field::content_type]));
  request.cookie = text(message[http::field::cookie]);
  request.authorization = text(message[http::field::authorization]);
  request.host = text(message[http::field::host]);
  request.origin = text(message[http::field::origin]);
  request.body = std::move(message.body());
  request.remote_address = peer_.remote_address;
  request.local_address = peer_.local_address;
  request.encrypted = std::is_same_v<Stream, TlsStream>;
}

template <typename Stream>
void HttpSession<Stream>::handle() {
  take_request_values();
  ApiRequest& request = request_;
  const auto& message = parser_->get();
  const bool keep_alive = message.keep_alive() && !context_.state.draining;
  const std::string target = text(message.target());
  if (target.size() > kMaxTargetBytes) {
    return respond(problem(414, "url-too-long", "at most 2 KiB"), false);
  }
  if (!parse_target(target, request)) {
    return respond(problem(400, "bad-url", "the URL holds a broken escape"), keep_alive);
  }
  if (message.count(http::field::host) > 1) {
    return respond(problem(400, "host-ambiguous", "send one Host header", "Host"), false);
  }
  if (request.host.empty()) return respond(problem(400, "host-missing", "send a Host header"), false);
  if (request.path == kStreamPath && request.method == Method::get) return open_stream();
  context_.app.answer(request, [self = this->shared_from_this(), keep_alive](ApiResponse response) {
    self->respond(std::move(response), keep_alive);
  });
}

template <typename Stream>
void HttpSession<Stream>::open_stream() {
  const auto& message = parser_->get();
  context_.app.identify(request_);
  if (auto refused = context_.app.refuse_stream(request_)) return respond(std::move(*refused), false);
  if (!opens_websocket(message)) {
    ApiResponse response = problem(400, "upgrade-needed", "open this with a WebSocket of version 13");
    response.headers.emplace_back("Sec-WebSocket-Version", "13");
    return respond(std::move(response), false);
  }
  http::token_list offered(message[http::field::sec_websocket_protocol]);
  if (!offered.exists({kStreamProtocol.data(), kStreamProtocol.size()})) {
    return respond(problem(400, "no-common-protocol", "offer flogmap.v1.proto", "Sec-WebSocket-Protocol"),
                   false);
  }
  beast::get_lowest_layer(stream_).expires_never();  // from here on the stream has its own deadlines
  std::make_shared<WsSession<Stream>>(std::move(stream_), context_, std::move(peer_), request_.role)
      ->run(parser_->release());
}

template <typename Stream>
void HttpSession<Stream>::respond(ApiResponse response, bool keep_alive) {
  response = finished(request_, std::move(response));
  head_ = response_head(response, keep_alive);
  body_ = request_.method == Method::head ? nullptr : response.body;
  context_.state.metrics.count_response(response.status, body_ ? body_->size() : 0);
  note(response.status);
  const std::array<net::const_buffer, 2> pieces{net::buffer(head_),
                                                body_ ? net::buffer(*body_) : net::const_buffer{}};
  beast::get_lowest_layer(stream_).expires_after(kWriteDeadline);
  net::async_write(stream_, pieces,
                   [self = this->shared_from_this(), keep_alive](ErrorCode error, std::size_t) {
                     self->on_written(error, keep_alive);
                   });
}

template <typename Stream>
void HttpSession<Stream>::note(int status) const {
  if (!log_wants(LogLevel::debug)) return;
  log_event(LogLevel::debug, "request",
            {{"remote", peer_.remote_address},
             {"method", parser_ ? text(parser_->get().method_string()) : std::string()},
             {"path", request_.path},
             {"status", std::int64_t{status}},
             {"bytes", static_cast<std::int64_t>(body_ ? body_->size() : 0)}});
}

template <typename Stream>
void HttpSession<Stream>::on_written(ErrorCode error, bool keep_alive) {
  body_ = nullptr;
  if (error) return;
  if (keep_alive) return wait_for_request();
  linger();
}

/// Ends the connection so that the peer gets to read the response although it may still be sending.
template <typename Stream>
void HttpSession<Stream>::linger() {
  ErrorCode ignored;
  auto& socket = beast::get_lowest_layer(stream_);
  if (lingered_ == 0) {
    socket.socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
    socket.expires_after(kLingerDeadline);
  }
  if (++lingered_ > kMaxLingerReads) return;
  buffer_.consume(buffer_.size());
  socket.async_read_some(buffer_.prepare(4096),
                         [self = this->shared_from_this()](ErrorCode error, std::size_t) {
                           if (!error) self->linger();
                         });
}

template class HttpSession<PlainStream>;
template class HttpSession<TlsStream>;

}  // namespace flogmap
