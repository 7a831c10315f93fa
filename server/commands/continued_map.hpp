// The map that a store holds, made fit to be gone on with.
#pragma once

#include <filesystem>
#include <optional>

#include "mapping/flog/flog_options.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// The stored map; nothing while none was begun. Throws std::runtime_error if its cells are not those of the
/// options. --min-rays and a given --full-confidence-rays hold from now on, also for what is stored. After a
/// kill its revisions are above all that viewers may know. If the tiles were behind the path, they are those
/// of the kept views now, each where the path has it.
std::optional<StoredMap> take_up(MapStore& store, const FlogOptions& flog);

/// load_map(), its tiles likewise those of its path.
StoredMap load_settled_map(const std::filesystem::path& file);

/// Builds the tiles anew from the kept views, each where the path has it; tiles that then show nothing become
/// unseen ones. Returns how many views there were; with none the map stays as it is. Kept views are sampled
/// and fewer than were mapped, so that a little less is known than before, but all in the right place.
int rebuild_from_views(StoredMap& map, const FlogOptions& flog);

}  // namespace flogmap
