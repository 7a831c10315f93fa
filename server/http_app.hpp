#pragma once

#include <chrono>
#include <functional>

#include "server/access.hpp"
#include "server/api/router.hpp"
#include "server/http_values.hpp"
#include "server/query_worker.hpp"
#include "server/server_state.hpp"
#include "server/web_files.hpp"

namespace flogmap {

/// From any request to its response: who asks, which resource, where its work is done. Knows no sockets.
class HttpApp {
 public:
  using Done = std::function<void(ApiResponse)>;
  /// Runs a function on the network thread; may be called from any thread.
  using Post = std::function<void(std::function<void()>)>;

  HttpApp(ServerState& state, Access& access, Post post);

  /// Calls `done` on the network thread, at once or when the query thread has finished. Fills in the role and
  /// the captures of the request, which must live until then.
  void answer(ApiRequest& request, Done done);

  /// The checks before a WebSocket is opened: nothing if it may be.
  std::optional<ApiResponse> refuse_stream(const ApiRequest& request);

  /// Ends the query thread; later queries are answered 503.
  void stop() { queries_.stop(); }

  /// Whom the request comes from; sets request.role.
  void identify(ApiRequest& request) const;

 private:
  std::optional<ApiResponse> refuse(const ApiRequest& request) const;
  std::optional<ApiResponse> refuse_guesses(const ApiRequest& request);
  void note_wrong_token(const ApiRequest& request, std::chrono::steady_clock::time_point now);
  ApiAnswer dispatch(ApiRequest& request);
  ApiResponse log_in(const ApiRequest& request);
  void run(const std::string& path, ApiJob job, Done done);

  ServerState& state_;
  Access& access_;
  Post post_;
  Router router_;
  WebFiles web_;
  QueryWorker queries_;
};

/// 304 if the client has it already, no body where none is due.
ApiResponse finished(const ApiRequest& request, ApiResponse response);

}  // namespace flogmap
