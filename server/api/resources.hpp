// The resources of INTERFACES section 3, one file each.
#pragma once

#include <vector>

#include "server/api/router.hpp"

namespace flogmap {

std::vector<Route> map_routes();         // /maps, /maps/{id}
std::vector<Route> tile_routes();        // /maps/{id}/layers/...
std::vector<Route> cell_routes();        // /maps/{id}/cell
std::vector<Route> trajectory_routes();  // /maps/{id}/trajectory
std::vector<Route> frame_routes();       // /frames/...
std::vector<Route> session_routes();     // /session
std::vector<Route> playback_routes();    // /playback
std::vector<Route> health_routes();      // /healthz, /readyz, /metrics
std::vector<Route> about_routes();       // /config, /calibration, /version
std::vector<Route> change_routes();      // /maps/{id}/changes
std::vector<Route> batch_routes();       // /maps/{id}/tiles:batchGet
std::vector<Route> image_routes();       // /maps/{id}/image.png
std::vector<Route> export_routes();      // /maps/{id}/export
std::vector<Route> route_routes();       // /maps/{id}/route
std::vector<Route> view_routes();        // /maps/{id}/views
std::vector<Route> calibrate_routes();   // /calibrate
std::vector<Route> docs_routes();        // /openapi.yaml, /docs

/// All of them.
std::vector<Route> all_routes();

}  // namespace flogmap
