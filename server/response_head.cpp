#include "server/response_head.hpp"

#include <array>
#include <ctime>

namespace flogmap {
namespace {

/// Nothing is fetched from elsewhere; pictures come over the stream as blobs; nobody may frame the page.
constexpr std::string_view kSecurity =
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";
constexpr std::string_view kPageSecurity =
    "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; "
    "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "X-Frame-Options: DENY\r\n";

/// The date as HTTP wants it, made once a second.
const std::string& http_date() {
  thread_local std::time_t made = 0;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now == made) return text;
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 64> line{};
  std::strftime(line.data(), line.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc);
  made = now;
  text = line.data();
  return text;
}

void add(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ").append(value).append("\r\n");
}

}  // namespace

std::string response_head(const ApiResponse& response, bool keep_alive) {
  std::string head;
  head.reserve(768);
  head.append("HTTP/1.1 ").append(std::to_string(response.status)).append(" ");
  head.append(reason_phrase(response.status)).append("\r\n");
  add(head, "Date", http_date());
  add(head, "Server", "flogmap");
  if (!response.content_type.empty()) add(head, "Content-Type", response.content_type);
  const bool has_length = response.status != 204 && response.status != 304;
  if (has_length) add(head, "Content-Length", std::to_string(response.body ? response.body->size() : 0));
  if (!response.etag.empty()) add(head, "ETag", response.etag);
  add(head, "Cache-Control", response.cache_control);
  for (const auto& [name, value] : response.headers) add(head, name, value);
  head.append(kSecurity);
  if (response.content_type.starts_with("text/html")) head.append(kPageSecurity);
  add(head, "Connection", keep_alive ? "keep-alive" : "close");
  head.append("\r\n");
  return head;
}

std::string refused_connection() {
  ApiResponse response = problem(429, "too-many-connections", "too many connections are open; close some");
  response.headers = {{"Retry-After", "5"}};
  return response_head(response, false) + *response.body;
}

}  // namespace flogmap
