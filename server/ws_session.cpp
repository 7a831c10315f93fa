#include "server/ws_session.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <chrono>
#include <string_view>
#include <utility>

#include "server/log.hpp"

namespace flogmap {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using std::chrono::seconds;
using std::chrono::steady_clock;

namespace {

constexpr seconds kHandshakeDeadline{5};
constexpr seconds kCloseDeadline{2};
constexpr std::size_t kMaxClientFrame = 64U << 10U;

}  // namespace

template <typename Stream>
WsSession<Stream>::WsSession(Stream stream, SessionContext context, Peer peer, Role role)
    : stream_(std::move(stream)),
      context_(context),
      peer_(std::move(peer)),
      protocol_(context.state, role, steady_clock::now()),
      watch_timer_(stream_.get_executor()),
      wake_timer_(stream_.get_executor()),
      read_(kMaxClientFrame + 1024) {}

template <typename Stream>
WsSession<Stream>::~WsSession() {
  context_.viewers.leave(*this);
}

template <typename Stream>
void WsSession<Stream>::run(beast::http::request<beast::http::string_body> upgrade) {
  upgrade_ = std::move(upgrade);
  websocket::stream_base::timeout deadlines{};
  deadlines.handshake_timeout = kHandshakeDeadline;
  deadlines.idle_timeout = websocket::stream_base::none();  // pings are ours: every 15 s
  stream_.set_option(deadlines);
  stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    response.set(beast::http::field::sec_websocket_protocol, "flogmap.v1.proto");
    response.set(beast::http::field::server, "flogmap");
  }));
  stream_.read_message_max(kMaxClientFrame);
  stream_.auto_fragment(false);
  stream_.binary(true);
  stream_.control_callback(
      [this](websocket::frame_type, boost::string_view) { protocol_.heard(steady_clock::now()); });
  ErrorCode ignored;
  beast::get_lowest_layer(stream_).socket().set_option(net::ip::tcp::no_delay(true), ignored);
  stream_.async_accept(upgrade_,
                       [self = this->shared_from_this()](ErrorCode error) { self->on_accept(error); });
}

template <typename Stream>
void WsSession<Stream>::on_accept(ErrorCode error) {
  upgrade_ = {};
  if (error) return;
  open_ = true;
  context_.viewers.join(*this);
  log_event(LogLevel::info, "viewer joined",
            {{"remote", peer_.remote_address}, {"viewers", std::int64_t{context_.state.num_viewers}}});
  watch();
  read();
}

template <typename Stream>
void WsSession<Stream>::read() {
  stream_.async_read(
      read_, [self = this->shared_from_this()](ErrorCode error, std::size_t) { self->on_read(error); });
}

template <typename Stream>
void WsSession<Stream>::on_read(ErrorCode error) {
  if (error) {
    // Beast has answered a frame over 64 KiB with 1009 itself.
    if (error == websocket::error::message_too_big) context_.state.metrics.count_closed_stream(1009);
    return cut();
  }
  const auto frame = read_.data();
  auto refused =
      stream_.got_binary()
          ? protocol_.receive({static_cast<const char*>(frame.data()), frame.size()}, steady_clock::now())
          : StreamClose{kCloseBadFrame, "frames are binary"};
  read_.consume(read_.size());
  if (refused) return close(*refused);
  pump();
  read();
}

template <typename Stream>
void WsSession<Stream>::pump() {
  if (!open_ || writing_) return;
  const auto now = steady_clock::now();
  writing_ = protocol_.outbox().next(*context_.state.live, now);
  if (!writing_) {
    if (const auto time = protocol_.outbox().next_at(*context_.state.live, now)) wake_at(*time);
    return;
  }
  context_.state.metrics.count_stream_message(writing_->size());
  stream_.async_write(net::buffer(*writing_), [self = this->shared_from_this()](
                                                  ErrorCode error, std::size_t) { self->on_written(error); });
}

template <typename Stream>
void WsSession<Stream>::on_written(ErrorCode error) {
  if (error) return cut();
  const Bytes written = std::exchange(writing_, nullptr);
  if (goodbye_ && written == goodbye_) return close({1001, "going away"});
  pump();
}

template <typename Stream>
void WsSession<Stream>::wake_at(Outbox::Time time) {
  if (wake_timer_.expiry() == time && time > steady_clock::now()) return;
  wake_timer_.expires_at(time);
  wake_timer_.async_wait([self = this->weak_from_this()](ErrorCode error) {
    const auto session = self.lock();
    if (!error && session) session->pump();
  });
}

template <typename Stream>
void WsSession<Stream>::watch() {
  watch_timer_.expires_after(seconds(1));
  watch_timer_.async_wait([weak = this->weak_from_this()](ErrorCode error) {
    const auto self = weak.lock();
    if (error || !self || !self->open_) return;
    const auto now = steady_clock::now();
    if (const auto overdue = self->protocol_.check_deadlines(now)) return self->close(*overdue);
    if (self->protocol_.ping_due(now) && !self->pinging_) {
      self->pinging_ = true;
      self->stream_.async_ping({}, [self](ErrorCode) { self->pinging_ = false; });
    }
    self->watch();
  });
}

template <typename Stream>
void WsSession<Stream>::dismiss(const std::string& reason) {
  if (!open_) return;
  goodbye_ = protocol_.goodbye(reason);
  watch_timer_.expires_after(kCloseDeadline);  // in place of watch(): one who does not read is cut off
  watch_timer_.async_wait([weak = this->weak_from_this()](ErrorCode error) {
    const auto self = weak.lock();
    if (!error && self) self->cut();
  });
  pump();
}

/// Says why and closes; cuts the line if the page does not answer in time.
template <typename Stream>
void WsSession<Stream>::close(const StreamClose& reason) {
  if (!open_) return;
  open_ = false;
  context_.state.metrics.count_closed_stream(reason.code);
  log_event(
      LogLevel::info, "viewer is sent away",
      {{"remote", peer_.remote_address}, {"code", std::int64_t{reason.code}}, {"reason", reason.reason}});
  wake_timer_.cancel();
  watch_timer_.expires_after(kCloseDeadline);
  watch_timer_.async_wait([weak = this->weak_from_this()](ErrorCode error) {
    const auto self = weak.lock();
    if (!error && self) self->cut();
  });
  const websocket::close_reason why(static_cast<websocket::close_code>(reason.code), reason.reason);
  stream_.async_close(why, [self = this->shared_from_this()](ErrorCode) { self->cut(); });
}

template <typename Stream>
void WsSession<Stream>::cut() {
  if (open_) log_event(LogLevel::info, "viewer left", {{"remote", peer_.remote_address}});
  open_ = false;
  context_.viewers.leave(*this);
  watch_timer_.cancel();
  wake_timer_.cancel();
  beast::get_lowest_layer(stream_).close();
}

template class WsSession<PlainStream>;
template class WsSession<TlsStream>;

}  // namespace flogmap
