#include "server/serve_options.hpp"

#include <arpa/inet.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "server/access.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kShortestSecret = 8;

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

bool is_numeric_address(const std::string& address) {
  std::array<unsigned char, 16> bytes{};
  return inet_pton(AF_INET, address.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1;
}

AccessToken token_of(Role role, const std::string& secret, const std::string& where) {
  if (secret.size() < kShortestSecret) refuse(where + ": a token needs at least 8 characters");
  if (secret.find_first_of(" \t\r") != std::string::npos) refuse(where + ": a token must not hold blanks");
  return {role, secret};
}

void append_file(const std::string& path, std::vector<AccessToken>& tokens) {
  std::ifstream file(path);
  if (!file) refuse(path + ": cannot be read; it should hold one 'view SECRET' or 'control SECRET' a line");
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string role, secret, more;
    if (!(words >> role)) continue;
    words >> secret;
    const std::string where = path + ":" + std::to_string(number);
    if (words >> more)
      refuse(where + ": more than 'view SECRET' or 'control SECRET'; a token holds no blanks");
    if (role != "view" && role != "control")
      refuse(where + ": role must be view or control, got '" + role + "'");
    tokens.push_back(token_of(role == "view" ? Role::view : Role::control, secret, where));
  }
}

/// Who is told a secret for looking must not get control with it.
void check_distinct(const std::vector<AccessToken>& tokens) {
  for (const AccessToken& a : tokens) {
    for (const AccessToken& b : tokens) {
      if (a.role == Role::view && b.role == Role::control && a.secret == b.secret)
        refuse("tokens: one secret is given for view and for control; each role needs its own");
    }
  }
}

void append_environment(const char* name, Role role, std::vector<AccessToken>& tokens) {
  const char* secret = std::getenv(name);
  if (secret && *secret) tokens.push_back(token_of(role, secret, name));
}

}  // namespace

std::vector<AccessToken> read_tokens(const std::string& path) {
  std::vector<AccessToken> tokens;
  if (!path.empty()) append_file(path, tokens);
  if (!path.empty() && tokens.empty()) refuse(path + ": holds no token; delete the option to serve without");
  append_environment("FLOGMAP_VIEW_TOKEN", Role::view, tokens);
  append_environment("FLOGMAP_CONTROL_TOKEN", Role::control, tokens);
  check_distinct(tokens);
  return tokens;
}

void check(const ServeOptions& options) {
  const std::string& address = options.listen_address;
  if (!is_numeric_address(address)) {
    refuse("listen: must be a numeric address and port such as 127.0.0.1:8080, got '" + address + "'");
  }
  if (!is_loopback(address) && options.tokens.empty() && !options.insecure_no_auth) {
    refuse("listen: " + address + " can be reached by others, so tokens are needed (--tokens FILE, or " +
           "FLOGMAP_VIEW_TOKEN and FLOGMAP_CONTROL_TOKEN), or --insecure-no-auth");
  }
  if (options.tls_cert.empty() != options.tls_key.empty()) refuse("tls-cert and tls-key go together");
  if (options.max_connections < 1) refuse("max-connections: must be at least 1");
  if (options.max_connections_per_address < 1) refuse("max-connections-per-address: must be at least 1");
  if (!(options.robot.radius_m >= 0 && options.robot.radius_m <= 5)) {
    refuse("robot-radius: must be in [0, 5] metres, got " + std::to_string(options.robot.radius_m));
  }
}

}  // namespace flogmap
