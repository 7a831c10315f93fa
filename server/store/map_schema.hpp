// The tables of map.flog and how a file is known to be one. docs/map-file.md is their description.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "server/store/sqlite.hpp"

namespace flogmap {

inline constexpr std::int64_t kMapApplicationId = 0x464C4F47;  // "FLOG"
inline constexpr std::int64_t kMapFormat = 1;  // user_version; rises with every change of tables

/// "FILE: damaged (WHAT); ..." with the way out.
std::runtime_error damaged(const std::string& file, const std::string& what);

/// True for a file without anything in it, as SQLite creates them.
bool is_blank(const SqliteDatabase& database);

/// Creates the tables in a blank file, all or nothing.
void create_map_schema(SqliteDatabase& database);

/// Throws std::runtime_error unless the file is a map of this format whose tables are exactly ours and whose
/// pages are sound.
void check_map_schema(const SqliteDatabase& database);

}  // namespace flogmap
