// A request and its response as plain values: all that the resources in api/ know of HTTP.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "server/serve_options.hpp"
#include "server/wire.hpp"

namespace flogmap {

enum class Method : std::uint8_t { get, head, post, patch, options, other };

struct ApiRequest {
  Method method = Method::get;
  std::string path;                                        // decoded, without the query
  std::vector<std::pair<std::string, std::string>> query;  // decoded
  std::vector<std::string> captures;                       // what stands for each {} of the route
  std::string accept;  // lower case, as are accept_encoding and content_type
  std::string accept_encoding;
  std::string if_none_match;
  std::string content_type;
  std::string cookie;
  std::string authorization;
  std::string host;
  std::string origin;
  std::string body;
  std::string remote_address;  // numeric, without port
  std::string local_address;
  bool encrypted = false;
  Role role = Role::none;

  /// The value of a query parameter; nothing if it is not there.
  [[nodiscard]] std::optional<std::string_view> parameter(std::string_view name) const;
};

/// A copy may be kept, but must be asked about each time.
inline constexpr const char* kLiveCache = "private, no-cache";

struct ApiResponse {
  int status = 200;
  std::string content_type;
  Bytes body;        // null: none
  std::string etag;  // strong, quotes included; empty: none
  std::string cache_control = "no-store";
  std::vector<std::pair<std::string, std::string>> headers;
};

/// A response that takes long to make: run on the query thread, on immutable data alone.
using ApiJob = std::function<ApiResponse()>;
using ApiAnswer = std::variant<ApiResponse, ApiJob>;

/// RFC 9457. `code` is for programs ("epoch-changed"), `detail` for people, `parameter` the offending one.
ApiResponse problem(int status, std::string_view code, std::string_view detail,
                    std::string_view parameter = {});

ApiResponse json_response(std::string json, int status = 200);

/// Likewise, of which a copy may be kept under this tag.
ApiResponse tagged_json(std::string json, std::string etag);

/// ASCII only: names of schemes and media types, which mean the same in any case.
std::string lower_case(std::string_view text);

/// Reason phrase of a status code.
std::string_view reason_phrase(int status);

/// Splits and decodes "/a%20b?c=d", or "http://host/a%20b?c=d" of which the host replaces the request's, into
/// path and query; false if an escape is broken or a byte is not allowed.
bool parse_target(std::string_view target, ApiRequest& into);

/// Of `offered` media types the one that an Accept header likes best, the first of equals; nothing if none.
std::optional<std::string_view> negotiate(std::string_view accept,
                                          const std::vector<std::string_view>& offered);

/// If-None-Match holds this tag (weak comparison) or "*".
bool etag_matches(std::string_view if_none_match, std::string_view etag);

}  // namespace flogmap
