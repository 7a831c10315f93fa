// What the running server tells its operator: one event a line on stderr, as text or as JSON. The one thing
// that belongs to the process and not to a part of it, as stderr itself does.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace flogmap {

enum class LogFormat : std::uint8_t { text, json };
enum class LogLevel : std::uint8_t { debug, info, warning, error };

struct LogOptions {
  LogFormat format = LogFormat::text;
  LogLevel level = LogLevel::info;  // and above
};

/// A detail of an event.
struct LogField {
  std::string_view name;
  std::variant<bool, std::int64_t, double, std::string> value;
};

/// Events are written while this lives; before and after they go nowhere. At most one at a time, and it must
/// outlive the threads that log. Who logs never
/// waits for whoever reads stderr: 1024 lines wait at most, then the oldest are dropped.
class LogScope {
 public:
  explicit LogScope(const LogOptions& options);
  ~LogScope();  // writes out what waits
  LogScope(const LogScope&) = delete;
  LogScope& operator=(const LogScope&) = delete;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// True if an event of this level is written at all: ask before collecting costly details.
bool log_wants(LogLevel level);

/// From any thread. Details may hold anything: what strangers sent cannot forge a line.
void log_event(LogLevel level, std::string_view message, std::initializer_list<LogField> fields = {});

/// The event without time and level: `the map begins epoch=1f reason="loop closed"`, or `"message":"the map
/// begins","epoch":"1f",...` for the inside of a JSON object.
std::string log_text(LogFormat format, std::string_view message, std::span<const LogField> fields);

}  // namespace flogmap
