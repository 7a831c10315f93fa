#include "server/api/resources.hpp"

namespace flogmap {

std::vector<Route> all_routes() {
  std::vector<Route> all;
  for (const auto& routes :
       {map_routes, tile_routes, cell_routes, change_routes, batch_routes, image_routes, trajectory_routes,
        route_routes, export_routes, frame_routes, session_routes, playback_routes, view_routes,
        calibrate_routes, about_routes, health_routes, docs_routes}) {
    for (const Route& route : routes()) all.push_back(route);
  }
  return all;
}

}  // namespace flogmap
