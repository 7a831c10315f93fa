#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <string>

#include "server/session_context.hpp"

namespace flogmap {

/// One WebSocket connection: moves frames between the socket and its StreamProtocol, one write at a time, and
/// asks for the next message only when the last one has left.
template <typename Stream>
class WsSession : public std::enable_shared_from_this<WsSession<Stream>>, public Viewer {
 public:
  WsSession(Stream stream, SessionContext context, Peer peer, Role role);
  ~WsSession() override;
  WsSession(const WsSession&) = delete;
  WsSession& operator=(const WsSession&) = delete;

  /// `upgrade` is the request that opens the stream.
  void run(boost::beast::http::request<boost::beast::http::string_body> upgrade);

  StreamProtocol& protocol() override { return protocol_; }
  void pump() override;
  void dismiss(const std::string& reason) override;

 private:
  using ErrorCode = boost::beast::error_code;

  void on_accept(ErrorCode error);
  void read();
  void on_read(ErrorCode error);
  void on_written(ErrorCode error);
  void watch();
  void wake_at(Outbox::Time time);
  void close(const StreamClose& reason);
  void cut();

  boost::beast::websocket::stream<Stream> stream_;
  SessionContext context_;
  Peer peer_;
  StreamProtocol protocol_;
  boost::asio::steady_timer watch_timer_;
  boost::asio::steady_timer wake_timer_;
  boost::beast::http::request<boost::beast::http::string_body> upgrade_;  // until accepted
  boost::beast::flat_buffer read_;
  Bytes writing_;  // null: idle
  Bytes goodbye_;
  bool open_ = false;
  bool pinging_ = false;
};

extern template class WsSession<PlainStream>;
extern template class WsSession<TlsStream>;

}  // namespace flogmap
