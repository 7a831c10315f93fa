#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <string>

#include "server/access.hpp"
#include "server/http_app.hpp"
#include "server/viewers.hpp"

namespace flogmap {

using PlainStream = boost::beast::tcp_stream;
using TlsStream = boost::beast::ssl_stream<boost::beast::tcp_stream>;

/// What a connection needs of the server; all of it outlives the connections.
struct SessionContext {
  ServerState& state;
  HttpApp& app;
  Viewers& viewers;
};

/// Both ends of a connection, numeric, without ports.
struct Peer {
  std::string remote_address;
  std::string local_address;
  ConnectionLimit::Ticket ticket;
};

}  // namespace flogmap
