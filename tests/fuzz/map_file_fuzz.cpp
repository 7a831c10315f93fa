// map.flog, by the first byte: a whole file, the cells of one tile, or a kept view. The latter two lie behind
// checksums in a file, where no blind change gets through.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "server/map_store.hpp"
#include "server/store/tile_blob.hpp"
#include "server/views/glb.hpp"
#include "server/views/view_codec.hpp"
#include "server/views/view_mesh.hpp"
#include "tests/fuzz/scratch_folder.hpp"

namespace {

void read_file(std::string_view bytes) {
  static const flogmap::fuzz::ScratchFolder folder;
  try {
    (void)flogmap::load_map(folder.write("map.flog", bytes));
  } catch (const std::runtime_error&) {
  }
}

void read_tile(std::span<const std::uint8_t> bytes) {
  static flogmap::TileCodec codec(1);
  (void)codec.decode(bytes);
}

void read_view(std::span<const std::uint8_t> bytes) {
  flogmap::StoredView view;
  view.codec = flogmap::kMeshViewCodec;
  view.bytes.assign(bytes.begin(), bytes.end());
  const auto unpacked = flogmap::unpack_view(view);
  if (!unpacked) return;
  const flogmap::StereoCamera camera{300, 160, 120, 0.1, unpacked->width_px, unpacked->height_px};
  (void)flogmap::glb_of(flogmap::mesh_of(*unpacked, camera), unpacked->jpeg, view.world_from_camera, "view");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> rest(data + 1, size - 1);
  if (data[0] == 'f') read_file({reinterpret_cast<const char*>(rest.data()), rest.size()});
  if (data[0] == 't') read_tile(rest);
  if (data[0] == 'v') read_view(rest);
  return 0;
}
