#include "server/api/resources.hpp"

namespace flogmap {

std::vector<Route> all_routes() {
  std::vector<Route> all;
  for (const auto& routes : {map_routes, cell_routes, trajectory_routes, frame_routes, session_routes,
                             playback_routes, health_routes, about_routes}) {
    for (const Route& route : routes()) all.push_back(route);
  }
  return all;
}

}  // namespace flogmap
