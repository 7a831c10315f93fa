#include "server/store/map_schema.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>

namespace flogmap {
namespace {

struct Table {
  std::string_view name;
  std::string_view sql;  // compared letter by letter with what a file says of itself
};

constexpr std::array<Table, 4> kTables{{
    {"meta",
     "CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT NOT NULL, checksum INTEGER NOT NULL) STRICT"},
    {"tiles",
     "CREATE TABLE tiles (x INTEGER NOT NULL, y INTEGER NOT NULL, revision INTEGER NOT NULL, "
     "cells BLOB NOT NULL, checksum INTEGER NOT NULL, PRIMARY KEY (x, y)) STRICT"},
    {"trajectory",
     "CREATE TABLE trajectory (number INTEGER PRIMARY KEY, timestamp_ns INTEGER NOT NULL, pose BLOB NOT "
     "NULL, "
     "state INTEGER NOT NULL, mapped INTEGER NOT NULL, checksum INTEGER NOT NULL) STRICT"},
    {"views",
     "CREATE TABLE views (number INTEGER PRIMARY KEY, timestamp_ns INTEGER NOT NULL, pose BLOB NOT NULL, "
     "codec INTEGER NOT NULL, data BLOB NOT NULL, checksum INTEGER NOT NULL) STRICT"},
}};

void check_identity(const SqliteDatabase& database) {
  const std::string& file = database.file();
  if (is_blank(database)) throw std::runtime_error(file + ": is empty; name a map.flog that holds a map");
  if (database.integer("PRAGMA application_id") != kMapApplicationId) {
    throw std::runtime_error(file + ": is not a map but a file of another program; name a map.flog");
  }
  const std::int64_t format = database.integer("PRAGMA user_version");
  if (format > kMapFormat) {
    throw std::runtime_error(file + ": was made by a newer flogmap (format " + std::to_string(format) +
                             ", this one reads up to " + std::to_string(kMapFormat) + "); update flogmap");
  }
  if (format < 1) throw damaged(file, "impossible format " + std::to_string(format));
}

void check_tables(const SqliteDatabase& database) {
  std::map<std::string, std::string, std::less<>> found;
  SqliteStatement rows = database.prepare("SELECT name, sql FROM sqlite_schema WHERE sql IS NOT NULL");
  while (rows.step()) found.emplace(rows.text(0), rows.text(1));
  if (found.size() != kTables.size()) throw damaged(database.file(), "its tables are not those of a map");
  for (const Table& table : kTables) {
    const auto it = found.find(table.name);
    if (it == found.end() || it->second != table.sql) {
      throw damaged(database.file(), "table " + std::string(table.name) + " is not as a map has it");
    }
  }
}

/// SQLite reads what a cut last page lacks as zeros. With a journal beside it a file may rightly be shorter.
void check_length(const SqliteDatabase& database) {
  std::error_code error;
  const auto journal = std::filesystem::file_size(database.file() + "-wal", error);
  if (!error && journal > 0) return;
  const auto pages = database.integer("PRAGMA page_count") * database.integer("PRAGMA page_size");
  const auto size = std::filesystem::file_size(database.file(), error);
  if (error || size != static_cast<std::uintmax_t>(pages)) {
    throw damaged(database.file(), "its length is " + std::to_string(size) + " instead of " +
                                       std::to_string(pages) + " bytes");
  }
}

}  // namespace

std::runtime_error damaged(const std::string& file, const std::string& what) {
  return std::runtime_error(file + ": damaged (" + what + "); use a copy of it, or map again");
}

bool is_blank(const SqliteDatabase& database) {
  return database.integer("SELECT count(*) FROM sqlite_schema") == 0 &&
         database.integer("PRAGMA application_id") == 0 && database.integer("PRAGMA user_version") == 0;
}

void create_map_schema(SqliteDatabase& database) {
  std::string sql = "BEGIN IMMEDIATE; PRAGMA application_id = " + std::to_string(kMapApplicationId) +
                    "; PRAGMA user_version = " + std::to_string(kMapFormat) + ";";
  for (const Table& table : kTables) sql.append(table.sql).append(";");
  database.execute(sql + "COMMIT");
}

void check_map_schema(const SqliteDatabase& database) {
  check_identity(database);
  check_length(database);
  check_tables(database);
  const std::string verdict = database.text("PRAGMA integrity_check(1)");
  if (verdict != "ok") throw damaged(database.file(), verdict);
}

}  // namespace flogmap
