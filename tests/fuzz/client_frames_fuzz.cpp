// What a page may say on the stream: frames one after the other, each behind its length in two bytes. The
// length 0xffff lets time pass and the map change instead. Nothing may crash, and nothing may pile up.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/stream_protocol.hpp"
#include "tests/fuzz/walked_map.hpp"

namespace {

using namespace flogmap;

/// Sends what is due, as a socket would; false if it never ends.
bool drain(StreamProtocol& protocol, ServerState& state, StreamProtocol::Time now) {
  constexpr int kMostMessages = 100'000;
  for (int i = 0; i < kMostMessages; ++i) {
    if (!protocol.outbox().next(*state.live, now)) return true;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::WalkedMap map;
  ServerState& state = map.state();
  StreamProtocol::Time now(std::chrono::hours(1));
  StreamProtocol protocol(state, Role::view, now);
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (rest.size() >= 2) {
    const std::size_t length = static_cast<std::size_t>(static_cast<unsigned char>(rest[0])) * 256 +
                               static_cast<unsigned char>(rest[1]);
    rest.remove_prefix(2);
    if (length == 0xffff) {
      now += std::chrono::milliseconds(500);
      protocol.outbox().changed(map.step());
    } else {
      if (protocol.receive(rest.substr(0, length), now)) return 0;
      rest.remove_prefix(std::min(length, rest.size()));
    }
    if (!drain(protocol, state, now)) std::abort();
    if (protocol.check_deadlines(now)) return 0;
  }
  return 0;
}
