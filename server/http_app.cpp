#include "server/http_app.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"
#include "server/log.hpp"

namespace flogmap {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kMaxWaitingQueries = 16;
constexpr std::string_view kLogin = "/api/v1/login";
constexpr std::string_view kLogout = "/api/v1/logout";
/// HttpSession opens it; nothing else can be done there.
constexpr std::string_view kStream = "/api/v1/stream";

/// What no request should be able to bring about.
ApiResponse fault(const std::string& path, const std::exception& error) {
  log_event(LogLevel::error, "a request failed", {{"path", path}, {"error", std::string(error.what())}});
  return problem(500, "internal", "a fault of the server");
}

ApiResponse busy() { return problem(503, "busy", "too many queries wait; try again soon"); }

ApiResponse too_many_attempts() {
  ApiResponse response = problem(429, "too-many-attempts", "wait a minute");
  response.headers = {{"Retry-After", "60"}};
  return response;
}

bool changes_something(Method method) { return method == Method::post || method == Method::patch; }

/// Maps and commands; what the program is and how it does can be asked to its end.
bool needs_the_mapping(const ApiRequest& request) {
  return request.path.starts_with("/api/v1/maps") || changes_something(request.method);
}

/// The secret of a login: JSON {"token": ...} or a form's token=...
std::string secret_of(const ApiRequest& request) {
  if (request.content_type.starts_with("application/x-www-form-urlencoded")) {
    ApiRequest form;
    if (parse_target("/?" + request.body, form)) return std::string(form.parameter("token").value_or(""));
    return {};
  }
  return string_field_of_json(request, "token");
}

}  // namespace

HttpApp::HttpApp(ServerState& state, Access& access, Post post)
    : state_(state),
      access_(access),
      post_(std::move(post)),
      router_(all_routes()),
      web_(state.options.web_root),
      queries_(kMaxWaitingQueries) {}

void HttpApp::identify(ApiRequest& request) const {
  request.role = access_.role_of(request.authorization, request.cookie, steady_clock::now());
}

std::optional<ApiResponse> HttpApp::refuse(const ApiRequest& request) const {
  if (!access_.host_allowed(request.host, request.local_address)) {
    return problem(403, "host-not-allowed", "this server does not answer to that name; see --allow-host",
                   "Host");
  }
  if (!access_.origin_allowed(request.origin, request.host, request.encrypted)) {
    return problem(403, "origin-not-allowed", "pages from elsewhere may not do this; see --allow-origin",
                   "Origin");
  }
  return std::nullopt;
}

void HttpApp::note_wrong_token(const ApiRequest& request, steady_clock::time_point now) {
  access_.count_failure(request.remote_address, now);
  log_event(LogLevel::warning, "wrong token", {{"remote", request.remote_address}});
}

/// A wrong bearer token counts as a wrong login does: who may not guess there may not guess here.
std::optional<ApiResponse> HttpApp::refuse_guesses(const ApiRequest& request) {
  if (request.authorization.empty() || access_.open_to_all()) return std::nullopt;
  const auto now = steady_clock::now();
  if (!access_.may_try(request.remote_address, now)) return too_many_attempts();
  if (request.role == Role::none) note_wrong_token(request, now);
  return std::nullopt;
}

std::optional<ApiResponse> HttpApp::refuse_stream(const ApiRequest& request) {
  if (auto refused = refuse(request)) return refused;
  if (auto refused = refuse_guesses(request)) return refused;
  if (request.role == Role::none) return problem(401, "token-needed", "log in first, or send a token");
  if (state_.draining) return problem(503, "draining", "shutting down");
  if (!state_.live) return problem(503, "starting", "the map has not begun yet");
  return std::nullopt;
}

void HttpApp::answer(ApiRequest& request, Done done) {
  identify(request);
  ApiAnswer answer;
  try {
    answer = dispatch(request);
  } catch (const RefusedRequest& refused) {
    answer = refused.response();
  } catch (const std::exception& error) {
    answer = fault(request.path, error);
  }
  if (auto* response = std::get_if<ApiResponse>(&answer)) {
    done(std::move(*response));
  } else {
    run(request.path, std::move(std::get<ApiJob>(answer)), std::move(done));
  }
}

ApiAnswer HttpApp::dispatch(ApiRequest& request) {
  if (!changes_something(request.method)) {
    if (!access_.host_allowed(request.host, request.local_address)) return *refuse(request);
  } else if (auto refused = refuse(request)) {
    return *refused;
  }
  if (auto refused = refuse_guesses(request)) return *refused;
  if (request.path == kLogin || request.path == kLogout) return log_in(request);
  if (request.path == kStream) return only_allowed(request, "GET");
  if (state_.draining && needs_the_mapping(request)) return problem(503, "draining", "shutting down");
  const bool reads = request.method == Method::get || request.method == Method::head;
  if (request.path == "/" || web_.holds(request.path)) {
    return reads ? web_.answer(request) : only_allowed(request, "GET, HEAD");
  }
  return router_.answer(request, state_);
}

ApiResponse HttpApp::log_in(const ApiRequest& request) {
  if (request.method != Method::post) return only_allowed(request, "POST");
  const auto now = steady_clock::now();
  const std::string attributes =
      std::string("; Path=/; HttpOnly; SameSite=Strict") + (request.encrypted ? "; Secure" : "");
  const std::string name(Access::kCookie);
  if (request.path == kLogout) {
    access_.log_out(request.cookie);
    ApiResponse response = json_response(R"({"role":"none"})");
    response.headers.emplace_back("Set-Cookie", name + "=; Max-Age=0" + attributes);
    return response;
  }
  if (access_.open_to_all()) return json_response(R"({"role":"control"})");
  if (!access_.may_try(request.remote_address, now)) return too_many_attempts();
  const std::string secret = secret_of(request);
  const auto cookie = access_.log_in(secret, now);
  if (!cookie) {
    note_wrong_token(request, now);
    return problem(401, "wrong-token", "this is no token of this server", "token");
  }
  const Role role = access_.role_of("Bearer " + secret, {}, now);
  ApiResponse response = json_response("{\"role\":\"" + std::string(name_of(role)) + "\"}");
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Access::kLoginLasts).count();
  response.headers.emplace_back("Set-Cookie",
                                name + "=" + *cookie + "; Max-Age=" + std::to_string(seconds) + attributes);
  return response;
}

void HttpApp::run(const std::string& path, ApiJob job, Done done) {
  // Owns the connection, which must end on the network thread even if its client has left meanwhile: handed
  // on whole, so that nothing of it stays with the worker.
  auto owner = std::make_shared<Done>(std::move(done));
  auto work = [this, path, job = std::move(job), owner] {
    const auto start = steady_clock::now();
    ApiResponse response;
    try {
      response = job();
    } catch (const RefusedRequest& refused) {
      response = refused.response();
    } catch (const std::exception& error) {
      response = fault(path, error);
    }
    const double seconds = std::chrono::duration<double>(steady_clock::now() - start).count();
    post_([this, seconds, response = std::move(response), done = std::exchange(*owner, nullptr)] {
      state_.metrics.observe_query_s(seconds);
      state_.num_waiting_queries = queries_.num_waiting();
      done(response);
    });
  };
  const bool taken = queries_.submit(std::move(work));
  state_.num_waiting_queries = queries_.num_waiting();
  if (!taken) (*owner)(busy());
}

ApiResponse finished(const ApiRequest& request, ApiResponse response) {
  const bool reads = request.method == Method::get || request.method == Method::head;
  if (reads && response.status == 200 && etag_matches(request.if_none_match, response.etag)) {
    response.status = 304;
    response.body = nullptr;
    response.content_type.clear();
  }
  return response;
}

}  // namespace flogmap
