#include "server/store/sqlite.hpp"

#include <sqlite3.h>

namespace flogmap {
namespace {

constexpr int kBusyTimeoutMs = 2000;
constexpr int kMaxBlobBytes = 256 << 20;  // a damaged length must not ask for more memory than this

SqliteFault fault_of(int code) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return SqliteFault::busy;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
    case SQLITE_TOOBIG:
      return SqliteFault::damaged;
    case SQLITE_FULL:
      return SqliteFault::disk_full;
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return SqliteFault::read_only;
    case SQLITE_IOERR:
      return SqliteFault::disk_error;
    case SQLITE_CANTOPEN:
      return SqliteFault::cannot_open;
    default:
      return SqliteFault::other;
  }
}

std::string in_words(int code, const char* detail) {
  switch (fault_of(code)) {
    case SqliteFault::busy:
      return "in use by another program; try again when it has finished";
    case SqliteFault::damaged:
      return "not a map or damaged (" + std::string(detail) + "); use a copy of it, or another file";
    case SqliteFault::disk_full:
      return "the disk is full; make room on it";
    case SqliteFault::read_only:
      return "the file or its folder is read-only; make it writable";
    case SqliteFault::disk_error:
      return "the disk refuses to read or write (" + std::string(detail) +
             "); check the disk and its free space";
    case SqliteFault::cannot_open:
      return "cannot be opened; check that its folder exists and may be written";
    case SqliteFault::other:
      break;
  }
  return std::string(detail) + "; use a copy of it, or another file";
}

[[noreturn]] void fail(const std::string& file, sqlite3* connection, int code) {
  const char* detail = connection != nullptr ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
  throw SqliteError(fault_of(code), file + ": " + in_words(code, detail));
}

/// "file:" URI of a path, which is the only way to say "immutable".
std::string uri_of(const std::string& path) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#' || byte < 0x20 || byte >= 0x7f) {
      uri += {'%', kHex[byte >> 4], kHex[byte & 15]};
    } else {
      uri += c;
    }
  }
  return uri;
}

int open_flags(SqliteDatabase::Mode mode) {
  constexpr int kCommon = SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  return kCommon | (mode == SqliteDatabase::Mode::write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                                                        : SQLITE_OPEN_READONLY);
}

}  // namespace

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void SqliteDatabase::Close::operator()(sqlite3* connection) const { sqlite3_close(connection); }

SqliteStatement& SqliteStatement::bind(int place, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), place, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int place, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), place, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int place, std::span<const std::uint8_t> blob) {
  static constexpr std::uint8_t kNothing = 0;  // a null pointer would be stored as NULL
  const auto* data = blob.empty() ? &kNothing : blob.data();
  sqlite3_bind_blob64(statement_.get(), place, data, blob.size(), SQLITE_STATIC);
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  fail(file_, sqlite3_db_handle(statement_.get()), code);
}

void SqliteStatement::run() {
  while (step()) {
  }
  reset();
}

void SqliteStatement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string_view SqliteStatement::text(int column) const {
  const auto* data = sqlite3_column_text(statement_.get(), column);
  if (data == nullptr) return {};
  return {reinterpret_cast<const char*>(data),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::span<const std::uint8_t> SqliteStatement::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  return {static_cast<const std::uint8_t*>(data),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

SqliteDatabase::SqliteDatabase(const std::filesystem::path& path, Mode mode) : file_(path.string()) {
  const std::string uri = uri_of(file_) + (mode == Mode::immutable ? "?immutable=1" : "");
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &connection, open_flags(mode), nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) fail(file_, connection, code);
  sqlite3_busy_timeout(connection, kBusyTimeoutMs);
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, kMaxBlobBytes);
  // A file from a stranger must not run anything, nor be believed about its own layout.
  sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  execute("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
}

void SqliteDatabase::execute(const std::string& sql) {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(file_, connection_.get(), code);
}

SqliteStatement SqliteDatabase::prepare(std::string_view sql) const {
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(connection_.get(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  SqliteStatement statement;
  statement.statement_.reset(raw);
  statement.file_ = file_;
  if (code != SQLITE_OK) fail(file_, connection_.get(), code);
  return statement;
}

std::int64_t SqliteDatabase::integer(std::string_view sql) const {
  SqliteStatement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::string SqliteDatabase::text(std::string_view sql) const {
  SqliteStatement statement = prepare(sql);
  return statement.step() ? std::string(statement.text(0)) : std::string();
}

bool SqliteDatabase::in_transaction() const { return sqlite3_get_autocommit(connection_.get()) == 0; }

}  // namespace flogmap
