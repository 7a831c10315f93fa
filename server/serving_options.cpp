// Options of the commands that serve.
#include <cmath>
#include <regex>
#include <sstream>

#include "server/options.hpp"

namespace flogmap {
namespace {

/// A name or address with or without a port: "robot.lan", "10.0.0.7:8080", "[fe80::1]:8080".
bool is_host(const std::string& text) {
  static const std::regex kHost(R"(([A-Za-z0-9._-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]{1,5})?)");
  return std::regex_match(text, kHost);
}

void check_host(const std::string& text) {
  if (!is_host(text)) throw UsageError("'" + text + "' is no host; allowed: NAME or NAME:PORT, as robot.lan");
}

void check_origin(const std::string& text) {
  static const std::regex kScheme("[a-z][a-z0-9+.-]*://");
  std::smatch scheme;
  const bool begins = std::regex_search(text, scheme, kScheme, std::regex_constants::match_continuous);
  if (!begins || !is_host(scheme.suffix()))
    throw UsageError("'" + text +
                     "' is no origin; allowed: SCHEME://HOST[:PORT] without a path, as https://robot.lan");
}

/// Words separated by commas, each as `check` allows.
Option list_option(const std::string& name, std::vector<std::string>& target, const std::string& value_name,
                   const std::string& help, void (*check)(const std::string&)) {
  const auto parse = [&target, check](const std::string& given) {
    target.clear();
    std::stringstream words(given);
    for (std::string word; std::getline(words, word, ',');) {
      if (word.empty()) continue;
      check(word);
      target.push_back(word);
    }
  };
  const auto show = [&target] {
    std::string text;
    for (const std::string& word : target) text += (text.empty() ? "" : ",") + word;
    return text;
  };
  return {.name = name, .value_name = value_name, .help = help, .parse = parse, .show = show};
}

/// Who may reach the server.
void add_access_options(OptionTable& table, Options& options) {
  ServeOptions& serve = options.serve;
  table.text("tokens", "FILE", options.tokens_file,
             "lines \"view SECRET\" and \"control SECRET\"; or FLOGMAP_VIEW_TOKEN, FLOGMAP_CONTROL_TOKEN");
  table.flag("insecure-no-auth", serve.insecure_no_auth, "serve other machines without a token");
  table.add(list_option("allow-host", serve.allow_hosts, "NAME,...",
                        "names by which browsers may reach this server", check_host));
  table.add(list_option("allow-origin", serve.allow_origins, "ORIGIN,...", "pages elsewhere that may use it",
                        check_origin));
  table.text("tls-cert", "FILE", serve.tls_cert, "PEM certificate chain; with --tls-key serves https");
  table.text("tls-key", "FILE", serve.tls_key, "PEM private key");
  table.integer("max-connections", "N", serve.max_connections, 1, 65535, "at a time");
  table.integer("max-connections-per-address", "N", serve.max_connections_per_address, 1, 65535, "at a time");
}

}  // namespace

void add_listen_options(OptionTable& table, Options& options) {
  ServeOptions& serve = options.serve;
  const auto show_listen = [&serve] {
    const bool v6 = serve.listen_address.find(':') != std::string::npos;
    return (v6 ? "[" + serve.listen_address + "]" : serve.listen_address) + ":" + std::to_string(serve.port);
  };
  const auto parse_listen = [&serve](const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) throw UsageError("must be ADDRESS:PORT, for instance 127.0.0.1:8080");
    const double port = parse_numbers(text.substr(colon + 1), 1)[0];
    if (port < 0 || port > 65535 || port != std::floor(port)) throw UsageError("the port must be 0 to 65535");
    std::string address = text.substr(0, colon);
    if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
    serve.listen_address = address.empty() ? "0.0.0.0" : address;
    serve.port = static_cast<std::uint16_t>(port);
  };
  table.add({.name = "listen",
             .value_name = "ADDRESS:PORT",
             .help = "where to serve; port 0 takes a free one",
             .parse = parse_listen,
             .show = show_listen});
  table.text("web-root", "DIR", serve.web_root, "folder of the built page");
  add_access_options(table, options);
}

void add_serve_options(OptionTable& table, Options& options) {
  ServeOptions& serve = options.serve;
  add_listen_options(table, options);
  table.choice<bool>("pace", options.as_fast_as_possible, {{"realtime", false}, {"fast", true}},
                     "replay a recording as it was recorded, or as fast as possible");
  table.flag("loop", options.source.loop, "start a recording again at its end, with a new map");
  table.text("store", "FILE", options.store, "keep the map here; it goes on after a restart");
  table.number("robot-radius", "METRES", serve.robot.radius_m, 0, 10, "of routes and the inflated maps");
  table.number("robot-height", "METRES", serve.robot.height_m, 0, 100,
               "layers above it do not matter; 0 = all do");
  table.text("maps", "DIR", options.maps_dir, "serve every *.flog in it beside the live map");
  table.choice<LogFormat>("log-format", options.log.format,
                          {{"text", LogFormat::text}, {"json", LogFormat::json}},
                          "of the events on stderr: a line to read, or a JSON object a line");
  table.choice<LogLevel>("log-level", options.log.level,
                         {{"debug", LogLevel::debug},
                          {"info", LogLevel::info},
                          {"warning", LogLevel::warning},
                          {"error", LogLevel::error}},
                         "events of this level and above are written; debug names every request");
}

}  // namespace flogmap
