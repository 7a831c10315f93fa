#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http_values.hpp"
#include "server/server_state.hpp"

namespace flogmap {

/// Makes the response to a request; pure but for what it asks of `state`. Runs on the network thread: what
/// takes longer than a few milliseconds is returned as a job on immutable data.
using Handler = ApiAnswer (*)(const ApiRequest& request, ServerState& state);

struct Route {
  Method method = Method::get;
  std::string_view pattern;  // "/api/v1/maps/{}/cell"; {} stands for one segment, {name.ext} is not known
  Role role = Role::view;    // that it takes; none: public
  Handler handler = nullptr;
};

class Router {
 public:
  explicit Router(std::vector<Route> routes);

  /// True if any route has this path.
  [[nodiscard]] bool knows(std::string_view path) const;

  /// Fills request.captures and calls the handler. 404, 405 with Allow, 401 and 403 come from here, and the
  /// answer to OPTIONS. HEAD goes to the GET route.
  [[nodiscard]] ApiAnswer answer(ApiRequest& request, ServerState& state) const;

 private:
  std::vector<Route> routes_;
};

/// 204 to OPTIONS, 405 to every other method; both say with Allow what there is ("GET, HEAD").
ApiResponse only_allowed(const ApiRequest& request, std::string allow);

/// Whether a path fits a pattern; what stands for each {} is appended to captures.
bool path_fits(std::string_view pattern, std::string_view path, std::vector<std::string>& captures);

}  // namespace flogmap
