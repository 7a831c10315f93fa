// Ten thousand malformed frames of every class: each gets its close code, and the server serves on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/server/client_frames.hpp"
#include "tests/server/hub_attack.hpp"

namespace flogmap {
namespace {

using ::testing::AnyOf;

constexpr int kFramesOfEach = 420;

/// A Subscribe of which four bytes are wrong.
std::string flipped_subscribe(std::mt19937& random) {
  std::string frame = subscribe_frame({{{}, Planes::evidence}, {}, 20, true});
  for (int i = 0; i < 4; ++i) frame[random() % frame.size()] = static_cast<char>(random());
  return frame;
}

struct FrameClass {
  std::string name;
  std::function<std::string()> make;
  ::testing::Matcher<int> code;
};

TEST_F(Attack, EveryMalformedFrameGetsItsCode) {
  const std::string hello = bytes_of({0x82, hello_frame()});
  const auto frame = [](std::uint8_t first, std::string payload) {
    return bytes_of({first, std::move(payload)});
  };
  const std::vector<FrameClass> classes{
      {"not masked",
       [&] {
         return bytes_of({0x82, hello_frame(), false});
       },
       1002},
      {"reserved bit", [&] { return frame(static_cast<std::uint8_t>(0x82 | 0x10U << random_() % 3), "x"); },
       1002},
      {"reserved opcode", [&] { return frame(static_cast<std::uint8_t>(0x83 + random_() % 5), "x"); }, 1002},
      {"long ping", [&] { return frame(0x89, std::string(126, 'p')); }, 1002},
      {"ping in parts", [&] { return frame(0x09, "p"); }, 1002},
      {"continues nothing", [&] { return frame(0x80, noise(20, false)); }, 1002},
      {"begins twice", [&] { return frame(0x02, "a") + frame(0x82, "b"); }, 1002},
      {"bad close code", [&] { return frame(0x88, std::string("\x03\xed", 2)); }, 1002},
      {"too long",
       [&] {
         return bytes_of({0x82, std::string(70000, 'x')});
       },
       1009},
      {"claims to be huge",
       [&] {
         return bytes_of({0x82, "x", true, std::uint64_t{1} << 40U});
       },
       1009},
      {"long in parts",
       [&] { return frame(0x02, std::string(40000, 'x')) + frame(0x80, std::string(40000, 'x')); }, 1009},
      {"text", [&] { return hello + frame(0x81, noise(50, true)); }, 4003},
      {"noise", [&] { return hello + frame(0x82, std::string(1, '\xff') + noise(300, false)); }, 4003},
      {"before Hello", [&] { return frame(0x82, ping_frame(random_())); }, 4003},
      {"second Hello", [&] { return hello + hello; }, 4003},
      {"unknown version",
       [&] { return frame(0x82, hello_frame(static_cast<std::uint32_t>(2 + random_() % 1000))); }, 4002},
      {"empty", [&] { return hello + frame(0x82, ""); }, 4003},
      {"text that is no UTF-8",
       [&] {
         return frame(0x82, hello_frame(Resume{noise(20, false) + '\xff', random_(), 0}));
       },
       4003},
      {"looks nowhere",
       [&] {
         return hello + frame(0x82, viewport_frame({{0, 0, std::nan(""), 1}, 0}));
       },
       4003},
      {"looks inside out",
       [&] {
         return hello + frame(0x82, viewport_frame({{static_cast<double>(random_()), 0, -1, 1}, 0}));
       },
       4003},
      {"inspects nowhere",
       [&] { return hello + frame(0x82, inspect_frame(HUGE_VAL, static_cast<double>(random_()))); }, 4003},
      {"no such layer",
       [&] {
         const int layer = 256 + static_cast<int>(random_() % 100'000);
         return hello + frame(0x82, subscribe_frame({{{layer}, Planes::value}, {}, 0, false}));
       },
       4003},
      {"acknowledges too much", [&] { return hello + frame(0x82, ack_frame(1U << 30U)); }, 4003},
      {"a flipped Subscribe",
       [&] { return hello + frame(0x82, flipped_subscribe(random_)) + frame(0x88, "\x03\xe8"); },
       AnyOf(4003, 1000)},
  };
  for (const FrameClass& one : classes) {
    for (int i = 0; i < kFramesOfEach; ++i) {
      ASSERT_THAT(close_code_after(server_.port(), one.make()), one.code) << one.name << " " << i;
    }
  }
  EXPECT_EQ(http(server_.port(), "GET", "/readyz").status, 200);
}

}  // namespace
}  // namespace flogmap
