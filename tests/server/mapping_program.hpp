// The running program with a store, and what it says of itself.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "server/map_store.hpp"
#include "tests/camera/small_scene.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/map_store_support.hpp"
#include "tests/server/running_program.hpp"

namespace flogmap {

inline constexpr auto kPatience = std::chrono::seconds(60);

/// A small scene walked through without end, its map kept beside it.
inline std::vector<std::string> mapping_into(const std::filesystem::path& store,
                                             const std::filesystem::path& folder) {
  std::ofstream(folder / "scene.json") << testing::kSmallScene;
  return {"--source", "sim:" + (folder / "scene.json").string(), "--pace", "fast", "--store", store.string()};
}

/// The store holds a map; what is no map makes load_map() throw.
inline bool holds_a_map(const std::filesystem::path& store) {
  return testing::error_of([&] { (void)load_map(store); }).empty();
}

inline nlohmann::json session_of(const RunningProgram& program) {
  return nlohmann::json::parse(http(program.port(), "GET", "/api/v1/session").body);
}

inline std::uint64_t revision_of(const RunningProgram& program) {
  const nlohmann::json session = session_of(program);
  return session["rev"].is_number() ? session["rev"].get<std::uint64_t>() : 0;
}

/// Until `holds` does; false after a minute.
template <typename Condition>
bool wait_until(const Condition& holds) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

inline bool is_ready(const RunningProgram& program) {
  return nlohmann::json::parse(http(program.port(), "GET", "/readyz").body)["ready"] == true;
}

/// What /readyz says of the store; empty if nothing. Only for a program that is ready.
inline std::string warning_of(const RunningProgram& program, const std::filesystem::path& store) {
  const nlohmann::json ready = nlohmann::json::parse(http(program.port(), "GET", "/readyz").body);
  EXPECT_EQ(ready["ready"], true);
  for (const std::string warning : ready["warnings"]) {
    if (warning.find(store.string()) != std::string::npos) return warning;
  }
  return {};
}

}  // namespace flogmap
