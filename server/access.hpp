// Who may do what. Pure but for the logins it remembers; the time is told.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve_options.hpp"

namespace flogmap {

/// "::1" and all of 127.0.0.0/8.
bool is_loopback(std::string_view address);

std::string_view name_of(Role role);

class Access {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::string_view kCookie = "flogmap_session";
  static constexpr std::chrono::hours kLoginLasts{12};

  explicit Access(const ServeOptions& options);

  /// The Host header names this server: a loopback name, the address the connection came in on, or an allowed
  /// name. Others are refused even without tokens, or a foreign page could reach us by DNS rebinding.
  [[nodiscard]] bool host_allowed(std::string_view host, std::string_view local_address) const;

  /// No Origin (not a browser), the page's own, or an allowed one.
  [[nodiscard]] bool origin_allowed(std::string_view origin, std::string_view host, bool encrypted) const;

  /// By `Authorization: Bearer` or login cookie; without any tokens everybody has control.
  [[nodiscard]] Role role_of(std::string_view authorization, std::string_view cookie, Time now) const;

  /// A new login's cookie value; nothing if the secret is no token.
  std::optional<std::string> log_in(std::string_view secret, Time now);
  void log_out(std::string_view cookie);

  /// False once an address has tried too many wrong secrets in the last minute.
  [[nodiscard]] bool may_try(const std::string& address, Time now);
  void count_failure(const std::string& address, Time now);

  [[nodiscard]] bool open_to_all() const { return tokens_.empty(); }

 private:
  struct Login {
    Role role = Role::none;
    Time until;
  };
  struct Failures {
    int count = 0;
    Time since;
  };

  [[nodiscard]] Role role_of_secret(std::string_view secret) const;

  std::vector<AccessToken> tokens_;
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
  std::map<std::string, Login, std::less<>> logins_;
  std::map<std::string, Failures> failures_;
};

/// Counts open connections, all in all and by address. Tickets give their place back when they go.
class ConnectionLimit {
 public:
  ConnectionLimit(int most, int most_per_address) : most_(most), most_per_address_(most_per_address) {}

  using Ticket = std::shared_ptr<void>;

  /// Null if there is no room. The limit must outlive its tickets.
  Ticket admit(const std::string& address);
  [[nodiscard]] int num_open() const { return num_open_; }

 private:
  int most_;
  int most_per_address_;
  int num_open_ = 0;
  std::map<std::string, int> open_by_address_;
};

}  // namespace flogmap
