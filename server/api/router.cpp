#include "server/api/router.hpp"

#include <array>
#include <utility>

namespace flogmap {
namespace {

constexpr std::size_t kMostCaptures = 8;

/// Cuts the text before the next '/' off the front.
std::string_view next_segment(std::string_view& rest) {
  const auto slash = rest.find('/');
  const std::string_view segment = rest.substr(0, slash);
  rest.remove_prefix(slash == std::string_view::npos ? rest.size() : slash + 1);
  return segment;
}

std::string_view name_of(Method method) {
  switch (method) {
    case Method::get:
      return "GET, HEAD";
    case Method::post:
      return "POST";
    case Method::patch:
      return "PATCH";
    default:
      return "";
  }
}

ApiResponse refused(const ApiRequest& request) {
  if (request.role != Role::none) return problem(403, "control-needed", "this takes the role control");
  return problem(401, "token-needed", "send a token, or log in at /api/v1/login");
}

}  // namespace

ApiResponse only_allowed(const ApiRequest& request, std::string allow) {
  allow += ", OPTIONS";
  ApiResponse response;
  if (request.method == Method::options) {
    response.status = 204;
  } else {
    response = problem(405, "method-not-allowed", request.path + " takes " + allow);
  }
  response.headers.emplace_back("Allow", std::move(allow));
  return response;
}

bool path_fits(std::string_view pattern, std::string_view path, std::vector<std::string>& captures) {
  std::array<std::string_view, kMostCaptures> captured;
  std::size_t num_captured = 0;
  while (!pattern.empty() && !path.empty()) {
    const std::string_view expected = next_segment(pattern), segment = next_segment(path);
    if (expected == "{}") {
      if (segment.empty() || num_captured == kMostCaptures) return false;
      captured[num_captured++] = segment;
    } else if (expected != segment) {
      return false;
    }
  }
  if (!pattern.empty() || !path.empty()) return false;
  captures.insert(captures.end(), captured.begin(), captured.begin() + num_captured);
  return true;
}

Router::Router(std::vector<Route> routes) : routes_(std::move(routes)) {}

bool Router::knows(std::string_view path) const {
  for (const Route& route : routes_) {
    std::vector<std::string> captures;
    if (path_fits(route.pattern, path, captures)) return true;
  }
  return false;
}

ApiAnswer Router::answer(ApiRequest& request, ServerState& state) const {
  std::string allow;
  const Method wanted = request.method == Method::head ? Method::get : request.method;
  for (const Route& route : routes_) {
    request.captures.clear();
    if (!path_fits(route.pattern, request.path, request.captures)) continue;
    if (route.method == wanted) {
      if (request.role < route.role) return refused(request);
      return route.handler(request, state);
    }
    allow += std::string(name_of(route.method)) + ", ";
  }
  if (allow.empty()) return problem(404, "not-found", "there is nothing at " + request.path);
  allow.erase(allow.size() - 2);
  return only_allowed(request, std::move(allow));
}

}  // namespace flogmap
