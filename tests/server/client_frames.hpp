#pragma once

#include <string>

#include "server/client_message.hpp"

namespace flogmap {

/// What a page sends: the inverse of decode_client_message().
std::string hello_frame(std::uint32_t version = kProtocolVersion);
std::string hello_frame(const Resume& resume);
std::string subscribe_frame(const Subscribe& wish);
std::string viewport_frame(const Viewport& viewport);
std::string ack_frame(std::uint64_t bytes);
std::string inspect_frame(double x_m, double y_m);
std::string ping_frame(std::uint64_t nonce);

}  // namespace flogmap
