// The requests that bring about the answers which the interface document declares.
#pragma once

#include <string>
#include <vector>

#include "tests/server/loopback_hub.hpp"

namespace flogmap {

inline const std::string kJson = "application/json";
inline const std::string kMap = "/api/v1/maps/{id}";  // as the document writes it

struct Case {
  std::string method, path, target;
  int status = 200;
  HttpHeaders headers{};
  std::string body{};
};

/// "get" → "GET".
std::string upper(std::string word);

/// Reading a map. `tile` is one of level 0 as "0/x/y", `first_view` the number of a view that is kept.
std::vector<Case> map_cases(const std::string& tile, const std::string& first_view);

/// Questions that are posted; a small robot can stand at `here`, "[x,y]".
std::vector<Case> posted_cases(const std::string& tile, const std::string& here);

/// Steering, in this order, of a program that is paused; and what it tells about itself.
std::vector<Case> session_cases();

}  // namespace flogmap
