// The page, the resources and the stream over TLS; versions before 1.2 are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <nlohmann/json.hpp>

#include "tests/server/client_frames.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/raw_stream.hpp"
#include "tests/server/synthetic_walk.hpp"
#include "tests/server/test_certificate.hpp"

namespace flogmap {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http_ = boost::beast::http;
namespace websocket = boost::beast::websocket;
using ::testing::HasSubstr;
using TlsClient = beast::ssl_stream<beast::tcp_stream>;

ServeOptions with_tls(const TestCertificate& certificate) {
  ServeOptions options;
  options.tls_cert = certificate.certificate_file();
  options.tls_key = certificate.key_file();
  options.tokens = {{Role::control, "control-secret"}};
  return options;
}

class Tls : public ::testing::Test {
 protected:
  Tls() : server_(with_tls(certificate_)) {
    server_.hub().begin(SyntheticWalk().begin("0123456789abcdef", "started"));
  }

  /// A client that speaks just this version, however old.
  std::unique_ptr<TlsClient> connect(int version) {
    context_ = std::make_unique<net::ssl::context>(net::ssl::context::tls_client);
    SSL_CTX_set_min_proto_version(context_->native_handle(), version);
    SSL_CTX_set_max_proto_version(context_->native_handle(), version);
    SSL_CTX_set_cipher_list(context_->native_handle(), "DEFAULT:@SECLEVEL=0");
    auto client = std::make_unique<TlsClient>(io_, *context_);
    beast::get_lowest_layer(*client).connect({net::ip::address_v4::loopback(), server_.port()});
    return client;
  }

  http_::response<http_::string_body> ask(TlsClient& client, http_::verb method, const std::string& target,
                                          const std::string& body = {}) {
    http_::request<http_::string_body> request(method, target, 11, body);
    request.set(http_::field::host, "localhost");
    request.set(http_::field::content_type, "application/json");
    request.prepare_payload();
    http_::write(client, request);
    beast::flat_buffer buffer;
    http_::response<http_::string_body> response;
    http_::read(client, buffer, response);
    return response;
  }

  TestCertificate certificate_;
  LoopbackHub server_;
  net::io_context io_;
  std::unique_ptr<net::ssl::context> context_;
};

TEST_F(Tls, VersionsFromOnePointTwoOnAreSpoken) {
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    const auto client = connect(version);
    client->handshake(net::ssl::stream_base::client);
    EXPECT_EQ(SSL_version(client->native_handle()), version);
    const auto page = ask(*client, http_::verb::get, "/");
    EXPECT_EQ(page.result_int(), 200U);
    EXPECT_THAT(std::string(page[http_::field::content_type]), HasSubstr("text/html"));
  }
}

TEST_F(Tls, OlderVersionsAreRefusedByTheServer) {
  for (const int version : {TLS1_VERSION, TLS1_1_VERSION}) {
    const auto client = connect(version);
    beast::error_code error;
    client->handshake(net::ssl::stream_base::client, error);
    ASSERT_TRUE(error);
    // The server's alert, not a complaint of this client about itself.
    EXPECT_EQ(ERR_GET_REASON(static_cast<unsigned long>(error.value())), SSL_R_TLSV1_ALERT_PROTOCOL_VERSION)
        << error.message();
  }
}

TEST_F(Tls, TheLoginCookieIsSentOverTlsAlone) {
  const auto client = connect(TLS1_3_VERSION);
  client->handshake(net::ssl::stream_base::client);
  const auto login = ask(*client, http_::verb::post, "/api/v1/login", R"({"token":"control-secret"})");
  EXPECT_EQ(login.result_int(), 200U);
  EXPECT_THAT(std::string(login[http_::field::set_cookie]), HasSubstr("; Secure"));
}

TEST_F(Tls, TheStreamWorksOverIt) {
  const auto client = connect(TLS1_3_VERSION);
  client->handshake(net::ssl::stream_base::client);
  websocket::stream<TlsClient&> stream(*client);
  stream.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
    request.set(http_::field::sec_websocket_protocol, "flogmap.v1.proto");
    request.set(http_::field::authorization, "Bearer control-secret");
  }));
  stream.handshake("localhost", "/api/v1/stream");
  stream.binary(true);
  stream.write(net::buffer(hello_frame()));
  beast::flat_buffer welcome;
  stream.read(welcome);
  EXPECT_GT(welcome.size(), 0U);
}

TEST_F(Tls, WhoSpeaksNoTlsIsCutOff) {
  RawConnection plain(server_.port());
  plain.send("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(plain.read_to_end(), ::testing::Not(HasSubstr("200 OK")));
}

TEST(TlsOptions, AKeyThatDoesNotFitIsOneClearLine) {
  const TestCertificate one, other;
  ServeOptions options = with_tls(one);
  options.tls_key = other.key_file();
  FakeSession session;
  try {
    Hub hub(options, session, {});
    FAIL() << "a foreign key was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(options.tls_key));
  }
}

}  // namespace
}  // namespace flogmap
