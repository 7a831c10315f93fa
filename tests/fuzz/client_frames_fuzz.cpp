// What a page may say on the stream: frames one after the other, each behind its length in two bytes. Three
// lengths that no frame has let something happen instead: time passes and the map changes, the path is
// rewritten, another map begins. Nothing may crash, and nothing may pile up.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/stream_protocol.hpp"
#include "tests/fuzz/small_map.hpp"

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

enum Event : std::size_t { map_begins = 0xfffd, path_rewritten = 0xfffe, map_changes = 0xffff };

void happen(std::size_t event, fuzz::SmallMap& map, StreamProtocol& protocol) {
  if (event == map_changes) protocol.outbox().changed(map.step());
  if (event == path_rewritten) {
    map.rewrite_path();
    protocol.outbox().rewritten("loop closed");
  }
  if (event == map_begins) {
    map.begin_map(1);
    protocol.reset("reset");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::SmallMap map;
  ServerState& state = map.state();
  map.begin_map(0);
  StreamProtocol::Time now(std::chrono::hours(1));
  StreamProtocol protocol(state, Role::view, now);
  int num_events = 0;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (rest.size() >= 2) {
    const std::size_t length = static_cast<std::size_t>(static_cast<unsigned char>(rest[0])) * 256 +
                               static_cast<unsigned char>(rest[1]);
    rest.remove_prefix(2);
    if (length >= map_begins) {
      constexpr int kMostEvents = 5;  // an overview costs more than a hundred frames
      if (++num_events > kMostEvents) return 0;
      now += std::chrono::milliseconds(500);
      happen(length, map, protocol);
    } else {
      if (protocol.receive(rest.substr(0, length), now)) return 0;
      rest.remove_prefix(std::min(length, rest.size()));
    }
    if (!drain(protocol, state, now)) std::abort();
    if (protocol.check_deadlines(now)) return 0;
  }
  return 0;
}
