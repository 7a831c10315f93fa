#include "server/log.hpp"

#include <spdlog/async_logger.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <nlohmann/json.hpp>

namespace flogmap {
namespace {

constexpr std::size_t kMostWaiting = 1024;

/// Where the events of the LogScope that lives go, and as what.
struct Writer {
  LogFormat format = LogFormat::text;
  std::shared_ptr<spdlog::details::thread_pool> pool =
      std::make_shared<spdlog::details::thread_pool>(kMostWaiting, 1);
  std::shared_ptr<spdlog::async_logger> logger =
      std::make_shared<spdlog::async_logger>("flogmap", std::make_shared<spdlog::sinks::stderr_sink_mt>(),
                                             pool, spdlog::async_overflow_policy::overrun_oldest);
};

std::atomic<Writer*> listening{nullptr};  // null: nobody listens

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

const char* pattern_of(LogFormat format) {
  return format == LogFormat::json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})"
                                   : "%Y-%m-%dT%H:%M:%S.%eZ %-7l %v";
}

/// As JSON; bytes that are no UTF-8 are replaced.
std::string json_of(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string json_of(const LogField& field) {
  return std::visit([](const auto& value) { return json_of(nlohmann::json(value)); }, field.value);
}

bool is_plain(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 ||
                        std::string_view("-_./:,+%@[]").find(static_cast<char>(c)) != std::string_view::npos);
  });
}

std::string text_of(const LogField& field) {
  const auto* word = std::get_if<std::string>(&field.value);
  return word != nullptr && is_plain(*word) ? *word : json_of(field);
}

}  // namespace

struct LogScope::Parts {
  Writer writer;
};

LogScope::LogScope(const LogOptions& options) : parts_(std::make_unique<Parts>()) {
  Writer& writer = parts_->writer;
  writer.format = options.format;
  writer.logger->set_formatter(std::make_unique<spdlog::pattern_formatter>(pattern_of(options.format),
                                                                           spdlog::pattern_time_type::utc));
  writer.logger->set_level(level_of(options.level));
  listening = &writer;
}

/// The writing thread ends first, with all that waits written; what it writes with goes after it.
LogScope::~LogScope() {
  listening = nullptr;
  parts_->writer.pool.reset();
}

bool log_wants(LogLevel level) {
  const Writer* writer = listening;
  return writer != nullptr && writer->logger->should_log(level_of(level));
}

void log_event(LogLevel level, std::string_view message, std::initializer_list<LogField> fields) {
  if (!log_wants(level)) return;
  const Writer& writer = *listening.load();
  const std::string text = log_text(writer.format, message, {fields.begin(), fields.size()});
  writer.logger->log(level_of(level), spdlog::string_view_t(text));
}

std::string log_text(LogFormat format, std::string_view message, std::span<const LogField> fields) {
  const bool json = format == LogFormat::json;
  std::string line = json ? "\"message\":" + json_of(std::string(message)) : std::string(message);
  for (const LogField& field : fields) {
    if (json) {
      line.append(",").append(json_of(std::string(field.name))).append(":").append(json_of(field));
    } else {
      line.append(" ").append(field.name).append("=").append(text_of(field));
    }
  }
  return line;
}

}  // namespace flogmap
