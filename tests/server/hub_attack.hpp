// A hub with a small map that anybody may attack from 256 connections.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>
#include <thread>

#include "tests/server/loopback_hub.hpp"
#include "tests/server/raw_stream.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {

inline ServeOptions many_connections() {
  ServeOptions options;
  options.max_connections = options.max_connections_per_address = 256;
  return options;
}

class Attack : public ::testing::Test {
 protected:
  Attack() : server_(many_connections()) {
    SyntheticWalk walk;
    server_.hub().begin(walk.begin("0123456789abcdef", "started"));
    for (int i = 0; i < 20; ++i) server_.hub().publish(walk.revision(), walk.step());
    while (http(server_.port(), "GET", "/api/v1/maps/live").status != 200)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  [[nodiscard]] std::string host() const {
    return "Host: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  }
  std::string noise(std::size_t most, bool printable) {
    std::string bytes(1 + random_() % most, '\0');
    for (char& c : bytes) c = static_cast<char>(printable ? '!' + random_() % 94 : random_() % 256);
    return bytes;
  }
  /// Of letters, at least five and never a name that means something here.
  std::string word() {
    std::string letters = "zq";
    for (std::size_t i = random_() % 20 + 3; i > 0; --i) letters += static_cast<char>('a' + random_() % 26);
    return letters;
  }
  [[nodiscard]] std::string get(const std::string& target, const std::string& more = {}) const {
    return "GET " + target + " HTTP/1.1\r\n" + host() + more + "\r\n";
  }
  [[nodiscard]] std::string patch(const std::string& body) const {
    return "PATCH /api/v1/playback HTTP/1.1\r\n" + host() +
           "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
           body;
  }
  /// The request that opens the stream, one part of it replaced.
  [[nodiscard]] std::string upgrade(const std::string& part, const std::string& by) const {
    std::string request = upgrade_request(server_.port());
    return request.replace(request.find(part), part.size(), by);
  }
  /// The status of the answer to these bytes; 0: closed without one.
  int status_after(const std::string& bytes) {
    RawConnection connection(server_.port());
    connection.send(bytes);
    const std::string answer = connection.read_until("\r\n");
    return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
  }

  LoopbackHub server_;
  std::mt19937 random_{20261122};
};

}  // namespace flogmap
