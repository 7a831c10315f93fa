// How the network side is to be run. Filled from command line, environment and file; checked once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapping/flog/map_value.hpp"

namespace flogmap {

class CalibrationDesk;

/// What a client may do. `view`: look at everything. `control`: also pause, reset and move the session.
enum class Role : std::uint8_t { none, view, control };

struct AccessToken {
  Role role = Role::view;
  std::string secret;
};

/// The robot that a route is planned for, and that the planning and motion maps are inflated by.
struct RobotBody {
  double radius_m = 0.2;
  double height_m = 0;  // of its top above z = 0; 0: all layers count
};

struct ServeOptions {
  std::string listen_address = "127.0.0.1";  // numeric IPv4 or IPv6
  std::uint16_t port = 8080;                 // 0: any free one
  std::string web_root;                      // the built page; empty: a page that says it is missing

  std::vector<AccessToken> tokens;  // empty: everybody who can connect has `control`
  bool insecure_no_auth = false;    // allow a non-loopback address without tokens
  std::vector<std::string>
      allow_hosts;  // names in the Host header besides loopback and numeric own addresses
  std::vector<std::string> allow_origins;  // "https://maps.example" besides the page's own origin
  std::string tls_cert;                    // PEM files; both or none
  std::string tls_key;

  int max_connections = 256;
  int max_connections_per_address = 32;

  Operators operators = Operators::algebraic;  // rules of the plane M, PNG tiles and inspector
  RobotBody robot;
};

/// What the server tells about itself: `GET /config`, `/calibration` and `/version` answer these documents.
struct HubInfo {
  std::string config_json = "{}";       // effective values and where each came from, secrets masked
  std::string calibration_json = "{}";  // of the rectified pair and the raw cameras
  std::string version = "unknown";
  CalibrationDesk* desk = nullptr;  // of `flogmap calibrate`; outlives the server
};

/// Tokens of a file, one `view SECRET` or `control SECRET` a line, '#' starts a comment; an empty path gives
/// none. Then those of the environment: FLOGMAP_VIEW_TOKEN and FLOGMAP_CONTROL_TOKEN. Throws
/// std::runtime_error naming file and line.
std::vector<AccessToken> read_tokens(const std::string& path);

/// Throws std::runtime_error naming option, value and what is allowed; refuses a non-loopback address without
/// tokens unless insecure_no_auth.
void check(const ServeOptions& options);

}  // namespace flogmap
