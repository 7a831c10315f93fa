#include "server/commands/serving.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>

#include "server/access.hpp"
#include "server/listener.hpp"
#include "server/log.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

/// The built page: beside the program in a checkout, or where `cmake --install` puts it.
std::string find_web_root() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const auto folder = program.parent_path();
  for (const auto& candidate : {folder / "../../web/dist", folder / "../share/flogmap/web"}) {
    if (std::filesystem::exists(candidate / "index.html", error)) {
      return std::filesystem::weakly_canonical(candidate, error).string();
    }
  }
  return {};
}

}  // namespace

void settle_serving(Options& options) {
  try {
    options.serve.tokens = read_tokens(options.tokens_file);
    check(options.serve);
    check_tls(options.serve);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
  if (options.serve.web_root.empty()) options.serve.web_root = find_web_root();
}

void announce(const Options& options, std::uint16_t port, const std::string& what, const std::string& page) {
  const std::string& address = options.serve.listen_address;
  const bool any = address == "0.0.0.0" || address == "::";
  const std::string host = any                                      ? "127.0.0.1"
                           : address.find(':') != std::string::npos ? "[" + address + "]"
                                                                    : address;
  const std::string scheme = options.serve.tls_cert.empty() ? "http" : "https";
  const std::string url = scheme + "://" + host + ":" + std::to_string(port) + page;
  if (options.log.format == LogFormat::text) {
    std::printf("%s: open %s in a browser (Ctrl-C ends)\n", what.c_str(), url.c_str());
    std::fflush(stdout);
  }
  log_event(LogLevel::info, "serving", {{"what", what}, {"url", url}, {"version", FLOGMAP_VERSION}});
  if (options.serve.insecure_no_auth && !is_loopback(address)) {
    log_event(LogLevel::warning,
              "everybody who can reach this address may look and control (--insecure-no-auth)");
  }
  if (options.serve.web_root.empty()) {
    log_event(LogLevel::warning, "the page is not built; run scripts/build");
  }
}

}  // namespace flogmap
