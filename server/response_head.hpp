#pragma once

#include <string>

#include "server/http_values.hpp"

namespace flogmap {

/// Status line and headers of a response, security headers included, up to the empty line.
std::string response_head(const ApiResponse& response, bool keep_alive);

/// A whole refusal for a connection that may not even ask: 429.
std::string refused_connection();

}  // namespace flogmap
