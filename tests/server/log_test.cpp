#include "server/log.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

namespace flogmap {
namespace {

using nlohmann::json;

/// The lines that work writes while events are written.
template <typename Work>
std::vector<std::string> lines_of(const LogOptions& options, const Work& work) {
  ::testing::internal::CaptureStderr();
  {
    const LogScope scope(options);
    work();
  }
  std::istringstream all(::testing::internal::GetCapturedStderr());
  std::vector<std::string> lines;
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  return lines;
}

TEST(Log, AnEventIsOneJsonObjectWithItsDetails) {
  const auto lines = lines_of({LogFormat::json, LogLevel::info}, [] {
    log_event(LogLevel::warning, "it happened", {{"count", std::int64_t{3}}, {"share", 0.5}, {"sure", true}});
  });
  ASSERT_EQ(lines.size(), 1U);
  const json event = json::parse(lines[0]);
  EXPECT_EQ(event["level"], "warning");
  EXPECT_EQ(event["message"], "it happened");
  EXPECT_EQ(event["count"], 3);
  EXPECT_EQ(event["share"], 0.5);
  EXPECT_EQ(event["sure"], true);
  EXPECT_EQ(event["time"].get<std::string>().size(), std::string("2026-01-01T00:00:00.000Z").size());
}

TEST(Log, WhatStrangersSendCannotForgeALine) {
  const std::string nasty = "a\nb\"},{\x1b[31m\xff%v{}";
  for (const LogFormat format : {LogFormat::text, LogFormat::json}) {
    const auto lines = lines_of({format, LogLevel::info}, [&] {
      log_event(LogLevel::info, "request", {{"path", nasty}});
    });
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].find('\x1b'), std::string::npos);
    if (format == LogFormat::json) {
      EXPECT_TRUE(json::parse(lines[0]).contains("path"));
    }
  }
}

TEST(Log, PlainWordsStayPlainInText) {
  const std::vector<LogField> fields{{"url", "http://127.0.0.1:8080"}, {"why", "it was asked for"}};
  EXPECT_EQ(log_text(LogFormat::text, "serving", fields),
            "serving url=http://127.0.0.1:8080 why=\"it was asked for\"");
}

TEST(Log, OnlyTheLevelAskedForAndAboveIsWritten) {
  const auto lines = lines_of({LogFormat::text, LogLevel::warning}, [] {
    EXPECT_FALSE(log_wants(LogLevel::info));
    EXPECT_TRUE(log_wants(LogLevel::error));
    log_event(LogLevel::info, "quiet");
    log_event(LogLevel::error, "loud");
  });
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("error"), std::string::npos);
}

TEST(Log, OutsideItsScopeEventsGoNowhere) {
  ::testing::internal::CaptureStderr();
  log_event(LogLevel::error, "nobody listens");
  EXPECT_FALSE(log_wants(LogLevel::error));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Log, LinesOfManyThreadsStayWhole) {
  constexpr int kThreads = 4, kLines = 100;
  const auto lines = lines_of({LogFormat::json, LogLevel::debug}, [] {
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([i] {
        for (int k = 0; k < kLines; ++k) log_event(LogLevel::debug, "line", {{"thread", std::int64_t{i}}});
      });
    }
  });
  EXPECT_EQ(lines.size(), std::size_t{kThreads * kLines});
  for (const std::string& line : lines) EXPECT_TRUE(json::parse(line, nullptr, false).is_object());
}

}  // namespace
}  // namespace flogmap
