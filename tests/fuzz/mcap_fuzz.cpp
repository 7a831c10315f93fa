// An MCAP file: opened as it is, every frame read, sought and read again. In chunks without checksums, so
// that what is changed inside is seen.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "camera/mcap_source.hpp"
#include "tests/fuzz/scratch_folder.hpp"

namespace {

constexpr int kMostFrames = 50;

/// Frames whose times increase, of one size; anything else is a fault.
void read_frames(flogmap::StereoSource& source) {
  std::int64_t last_ns = 0;
  for (int i = 0; i < kMostFrames; ++i) {
    const auto frame = source.next();
    if (!frame) return;
    const bool later = i == 0 || frame->timestamp_ns > last_ns;
    const bool same_size =
        frame->left.width == frame->right.width && frame->left.height == frame->right.height;
    if (!later || !same_size || frame->left.empty()) std::abort();
    last_ns = frame->timestamp_ns;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flogmap::fuzz::ScratchFolder folder;
  const auto file = folder.write("bag.mcap", {reinterpret_cast<const char*>(data), size});
  try {
    const auto source = flogmap::open_mcap({.spec = "mcap:bag", .where = file.string()});
    const flogmap::SourceInfo info = source->info();
    read_frames(*source);
    source->seek(info.first_timestamp_ns / 2 + info.last_timestamp_ns / 2);
    read_frames(*source);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
