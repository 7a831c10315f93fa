#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/session_context.hpp"

namespace flogmap {

/// One HTTP connection: reads requests one after the other and writes their responses. Hands itself over to a
/// WsSession when the page asks for the stream. Deadlines: 5 s for a header, 10 s for a body and for a write.
template <typename Stream>
class HttpSession : public std::enable_shared_from_this<HttpSession<Stream>> {
 public:
  HttpSession(Stream stream, SessionContext context, Peer peer);

  void run();

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  using ErrorCode = boost::beast::error_code;

  void wait_for_request();
  void read_header();
  void on_header(ErrorCode error);
  void on_body(ErrorCode error);
  void handle();
  void open_stream();
  bool refuse_early(ErrorCode error);
  void respond(ApiResponse response, bool keep_alive);
  void note(int status) const;
  void on_written(ErrorCode error, bool keep_alive);
  void linger();
  void take_request_values();

  Stream stream_;
  SessionContext context_;
  Peer peer_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  ApiRequest request_;  // that is being answered
  std::string head_;    // of the response that is being written
  Bytes body_;
  int lingered_ = 0;
};

extern template class HttpSession<PlainStream>;
extern template class HttpSession<TlsStream>;

}  // namespace flogmap
