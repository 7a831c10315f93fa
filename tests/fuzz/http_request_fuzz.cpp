// Any request to any resource: "METHOD TARGET", lines "name: value", an empty line, the body. Whatever it
// says, the answer is one that the interface knows, and nothing is a fault of the server.
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <optional>

#include "server/http_app.hpp"
#include "server/response_head.hpp"
#include "tests/fuzz/walked_map.hpp"

namespace {

using namespace flogmap;

std::string_view next_line(std::string_view& rest) {
  const auto end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

Method method_of(std::string_view name) {
  if (name == "GET") return Method::get;
  if (name == "HEAD") return Method::head;
  if (name == "POST") return Method::post;
  if (name == "PATCH") return Method::patch;
  return name == "OPTIONS" ? Method::options : Method::other;
}

void set_header(ApiRequest& request, std::string_view line) {
  const auto colon = line.find(": ");
  if (colon == std::string_view::npos) return;
  const std::string_view name = line.substr(0, colon);
  const std::string value(line.substr(colon + 2));
  if (name == "accept") request.accept = value;
  if (name == "accept-encoding") request.accept_encoding = value;
  if (name == "if-none-match") request.if_none_match = value;
  if (name == "content-type") request.content_type = value;
  if (name == "cookie") request.cookie = value;
  if (name == "authorization") request.authorization = value;
  if (name == "host") request.host = value;
  if (name == "origin") request.origin = value;
}

std::optional<ApiRequest> request_of(std::string_view text) {
  ApiRequest request;
  request.host = "localhost";
  request.remote_address = request.local_address = "127.0.0.1";
  const std::string_view line = next_line(text);
  const auto blank = line.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  request.method = method_of(line.substr(0, blank));
  if (!parse_target(line.substr(blank + 1), request)) return std::nullopt;
  for (std::string_view header = next_line(text); !header.empty(); header = next_line(text)) {
    set_header(request, header);
  }
  request.body = text;
  return request;
}

/// Waits for the answer, which may come from the query thread.
class Answer {
 public:
  void give(ApiResponse response) {
    const std::lock_guard lock(mutex_);
    response_ = std::move(response);
    given_.notify_one();
  }
  ApiResponse wait() {
    std::unique_lock lock(mutex_);
    given_.wait(lock, [this] { return response_.has_value(); });
    return *response_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable given_;
  std::optional<ApiResponse> response_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ServeOptions options;
  options.tokens = {{Role::view, "view-secret"}, {Role::control, "control-secret"}};
  static fuzz::WalkedMap map(options);
  static Access access(options);
  static HttpApp app(map.state(), access, [](const std::function<void()>& task) { task(); });
  auto request = request_of({reinterpret_cast<const char*>(data), size});
  if (!request) return 0;
  Answer answer;
  app.answer(*request, [&](ApiResponse response) { answer.give(std::move(response)); });
  const ApiResponse response = finished(*request, answer.wait());
  (void)response_head(response, true);
  if (response.status < 200 || response.status == 500) std::abort();
  return 0;
}
