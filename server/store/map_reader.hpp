// Reading a map out of its tables, everything checked on the way.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/map_store.hpp"
#include "server/store/sqlite.hpp"

namespace flogmap {

/// The whole map as of one moment. Throws std::runtime_error if anything is missing, damaged or impossible.
/// The tables themselves were checked by check_map_schema(); there must be a header.
StoredMap read_map(SqliteDatabase& database);

std::optional<StoredView> read_view(const SqliteDatabase& database, std::int64_t number);
std::vector<std::int64_t> read_view_numbers(const SqliteDatabase& database);

}  // namespace flogmap
