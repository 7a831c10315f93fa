#include "server/access.hpp"

#include <arpa/inet.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

#include "server/http_values.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kMostLogins = 1024;
constexpr std::size_t kMostFailingAddresses = 4096;
constexpr int kMostFailures = 10;

bool is_port(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc{} && end == text.data() + text.size() && port > 0 && port < 65'536;
}

/// The host without port; brackets of an IPv6 address stay off. Empty if it is no such thing.
std::string_view host_name(std::string_view host) {
  const bool bracketed = host.starts_with('[');
  const auto behind = bracketed ? host.find(']') : host.find(':');
  if (bracketed && behind == std::string_view::npos) return {};
  const std::string_view name = bracketed ? host.substr(1, behind - 1) : host.substr(0, behind);
  const std::string_view rest = host.substr(std::min(host.size(), bracketed ? behind + 1 : behind));
  const bool port_is_good = rest.empty() || (rest.front() == ':' && is_port(rest.substr(1)));
  return port_is_good ? name : std::string_view{};
}

bool same_secret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string random_name() {
  std::array<unsigned char, 24> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("no random bytes");
  std::string name;
  for (const unsigned char byte : bytes) {
    name += "0123456789abcdef"[byte >> 4U];
    name += "0123456789abcdef"[byte & 15U];
  }
  return name;
}

/// The value of our cookie in a Cookie header; empty if it is not there.
std::string_view cookie_value(std::string_view header) {
  while (!header.empty()) {
    const auto end = header.find(';');
    std::string_view pair = header.substr(0, end);
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (pair.starts_with(Access::kCookie) && pair.substr(Access::kCookie.size()).starts_with('=')) {
      return pair.substr(Access::kCookie.size() + 1);
    }
    if (end == std::string_view::npos) break;
    header.remove_prefix(end + 1);
  }
  return {};
}

}  // namespace

bool is_loopback(std::string_view address) {
  // Parsed, not compared by its beginning: "127.0.0.1.evil.example" is a name, and could be anybody.
  in_addr v4{};
  in6_addr v6{};
  const std::string text(address);
  if (inet_pton(AF_INET, text.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24U == 127;
  return inet_pton(AF_INET6, text.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

std::string_view name_of(Role role) {
  switch (role) {
    case Role::view:
      return "view";
    case Role::control:
      return "control";
    case Role::none:
      break;
  }
  return "none";
}

Access::Access(const ServeOptions& options)
    : tokens_(options.tokens), hosts_(options.allow_hosts), origins_(options.allow_origins) {}

bool Access::host_allowed(std::string_view host, std::string_view local_address) const {
  const std::string_view name = host_name(host);
  if (name.empty()) return false;
  if (name == "localhost" || name == local_address || is_loopback(name)) return true;
  return std::any_of(hosts_.begin(), hosts_.end(),
                     [&](const std::string& allowed) { return allowed == name || allowed == host; });
}

bool Access::origin_allowed(std::string_view origin, std::string_view host, bool encrypted) const {
  if (origin.empty()) return true;
  const std::string_view scheme = encrypted ? "https://" : "http://";
  if (origin.starts_with(scheme) && origin.substr(scheme.size()) == host) return true;
  return std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

Role Access::role_of(std::string_view authorization, std::string_view cookie, Time now) const {
  if (open_to_all()) return Role::control;
  constexpr std::string_view kBearer = "bearer ";
  if (lower_case(authorization.substr(0, kBearer.size())) == kBearer) {
    return role_of_secret(authorization.substr(kBearer.size()));
  }
  const auto login = logins_.find(cookie_value(cookie));
  return login != logins_.end() && now < login->second.until ? login->second.role : Role::none;
}

Role Access::role_of_secret(std::string_view secret) const {
  Role best = Role::none;
  for (const AccessToken& token : tokens_) {  // all of them: the time must not tell which one nearly fitted
    if (same_secret(token.secret, secret)) best = std::max(best, token.role);
  }
  return best;
}

std::optional<std::string> Access::log_in(std::string_view secret, Time now) {
  const Role role = role_of_secret(secret);
  if (role == Role::none) return std::nullopt;
  std::erase_if(logins_, [now](const auto& login) { return login.second.until <= now; });
  if (logins_.size() >= kMostLogins) {
    logins_.erase(std::min_element(logins_.begin(), logins_.end(), [](const auto& a, const auto& b) {
      return a.second.until < b.second.until;
    }));
  }
  std::string name = random_name();
  logins_[name] = {role, now + kLoginLasts};
  return name;
}

void Access::log_out(std::string_view cookie) {
  const auto login = logins_.find(cookie_value(cookie));
  if (login != logins_.end()) logins_.erase(login);
}

bool Access::may_try(const std::string& address, Time now) {
  const auto failures = failures_.find(address);
  if (failures == failures_.end()) return true;
  if (now - failures->second.since < std::chrono::minutes(1)) return failures->second.count < kMostFailures;
  failures_.erase(failures);
  return true;
}

void Access::count_failure(const std::string& address, Time now) {
  if (failures_.size() >= kMostFailingAddresses) failures_.clear();
  Failures& failures = failures_[address];
  if (failures.count++ == 0) failures.since = now;
}

ConnectionLimit::Ticket ConnectionLimit::admit(const std::string& address) {
  int& open_here = open_by_address_[address];
  if (num_open_ >= most_ || open_here >= most_per_address_) {
    if (open_here == 0) open_by_address_.erase(address);
    return nullptr;
  }
  ++num_open_;
  ++open_here;
  return {this, [this, address](void*) {
            --num_open_;
            if (--open_by_address_[address] == 0) open_by_address_.erase(address);
          }};
}

}  // namespace flogmap
