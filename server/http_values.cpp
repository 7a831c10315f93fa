#include "server/http_values.hpp"

#include <array>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

namespace flogmap {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Calls visit(part) for each part of a comma-separated header.
template <typename Visit>
void for_each_part(std::string_view text, char separator, Visit visit) {
  while (!text.empty()) {
    const auto end = text.find(separator);
    visit(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0 || (high == 0 && low == 0)) return std::nullopt;
      out.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      out.push_back(plus_is_space && text[i] == '+' ? ' ' : text[i]);
    }
  }
  return out;
}

/// How much an Accept header likes a media type, 0 to 1; the most specific range decides.
double liking(std::string_view accept, std::string_view type) {
  double best = 0;
  std::size_t best_specificity = 0;
  for_each_part(accept, ',', [&](std::string_view range) {
    const std::string_view name = trimmed(range.substr(0, range.find(';')));
    const bool any = name == "*/*";
    const bool any_subtype =
        name.size() > 2 && name.ends_with("/*") && type.starts_with(name.substr(0, name.size() - 1));
    if (!any && !any_subtype && name != type) return;
    double q = 1;
    if (const auto at = range.find("q="); at != std::string_view::npos) {
      q = 0;
      std::from_chars(range.data() + at + 2, range.data() + range.size(), q);
    }
    const std::size_t specificity = any ? 1 : any_subtype ? 2 : 3;
    if (specificity < best_specificity) return;
    best_specificity = specificity;
    best = q;
  });
  return best;
}

/// What stands before the path of an absolute URL, as proxies are asked for; empty where it begins with the
/// path.
std::string_view take_authority(std::string_view& target) {
  const auto colon = target.find("://");
  const std::string scheme = lower_case(target.substr(0, colon));
  if (colon == std::string_view::npos || (scheme != "http" && scheme != "https")) return {};
  target.remove_prefix(scheme.size() + 3);
  const std::string_view authority = target.substr(0, target.find_first_of("/?"));
  target.remove_prefix(authority.size());
  return authority;
}

/// "?c=d&e=f", or nothing.
bool parse_query(std::string_view query, ApiRequest& into) {
  if (query.empty()) return true;
  bool good = true;
  for_each_part(query.substr(1), '&', [&](std::string_view part) {
    if (part.empty()) return;
    const auto equals = part.find('=');
    const auto key = percent_decoded(part.substr(0, equals), true);
    const auto value = equals == std::string_view::npos ? std::optional<std::string>("")
                                                        : percent_decoded(part.substr(equals + 1), true);
    good = good && key && value;
    if (good) into.query.emplace_back(*key, *value);
  });
  return good;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

std::optional<std::string_view> ApiRequest::parameter(std::string_view name) const {
  for (const auto& [key, value] : query) {
    if (key == name) return value;
  }
  return std::nullopt;
}

ApiResponse problem(int status, std::string_view code, std::string_view detail, std::string_view parameter) {
  nlohmann::ordered_json document;
  document["type"] = "about:blank";
  document["title"] = reason_phrase(status);
  document["status"] = status;
  document["detail"] = detail;
  document["code"] = code;
  if (!parameter.empty()) document["parameter"] = parameter;
  ApiResponse response;
  response.status = status;
  response.content_type = "application/problem+json";
  // Input that is not UTF-8 may stand in the detail.
  response.body = to_shared(document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (status == 401) response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"flogmap\"");
  if (status == 429 || status == 503) response.headers.emplace_back("Retry-After", "1");
  return response;
}

ApiResponse json_response(std::string json, int status) {
  ApiResponse response;
  response.status = status;
  response.content_type = "application/json";
  response.body = to_shared(std::move(json));
  return response;
}

ApiResponse tagged_json(std::string json, std::string etag) {
  ApiResponse response = json_response(std::move(json));
  response.etag = std::move(etag);
  response.cache_control = kLiveCache;
  return response;
}

std::string_view reason_phrase(int status) {
  constexpr std::array<std::pair<int, std::string_view>, 20> kPhrases{{
      {200, "OK"},
      {204, "No Content"},
      {303, "See Other"},
      {304, "Not Modified"},
      {400, "Bad Request"},
      {401, "Unauthorized"},
      {403, "Forbidden"},
      {404, "Not Found"},
      {405, "Method Not Allowed"},
      {406, "Not Acceptable"},
      {408, "Request Timeout"},
      {409, "Conflict"},
      {413, "Content Too Large"},
      {414, "URI Too Long"},
      {415, "Unsupported Media Type"},
      {422, "Unprocessable Content"},
      {429, "Too Many Requests"},
      {431, "Request Header Fields Too Large"},
      {500, "Internal Server Error"},
      {503, "Service Unavailable"},
  }};
  for (const auto& [code, phrase] : kPhrases) {
    if (code == status) return phrase;
  }
  return "Unknown";
}

bool parse_target(std::string_view target, ApiRequest& into) {
  if (const std::string_view authority = take_authority(target); !authority.empty()) {
    into.host = authority;
    if (target.empty() || target.front() == '?') {
      into.path.assign(1, '/');
      return parse_query(target, into);
    }
  }
  const std::string_view raw_path = target.substr(0, target.find('?'));
  const auto path = percent_decoded(raw_path, false);
  if (!path || !path->starts_with('/')) return false;
  into.path = *path;
  return parse_query(target.substr(raw_path.size()), into);
}

std::optional<std::string_view> negotiate(std::string_view accept,
                                          const std::vector<std::string_view>& offered) {
  if (trimmed(accept).empty()) return offered.front();
  std::optional<std::string_view> best;
  double best_liking = 0;
  for (const std::string_view type : offered) {
    const double q = liking(accept, type);
    if (q > best_liking) {
      best = type;
      best_liking = q;
    }
  }
  return best;
}

bool etag_matches(std::string_view if_none_match, std::string_view etag) {
  if (if_none_match.empty() || etag.empty()) return false;
  bool matches = false;
  for_each_part(if_none_match, ',', [&](std::string_view tag) {
    if (tag.starts_with("W/")) tag.remove_prefix(2);
    matches = matches || tag == "*" || tag == etag;
  });
  return matches;
}

}  // namespace flogmap
