// SQLite with owners instead of pointers, and errors in words. sqlite3.h stays in the .cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace flogmap {

/// What went wrong, as far as the way out differs.
enum class SqliteFault : std::uint8_t { other, busy, damaged, disk_full, read_only, disk_error, cannot_open };

class SqliteError : public std::runtime_error {
 public:
  SqliteError(SqliteFault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
  [[nodiscard]] SqliteFault fault() const { return fault_; }

 private:
  SqliteFault fault_;
};

/// One prepared statement. Parameters are bound in order from 1, columns are read in order from 0.
class SqliteStatement {
 public:
  SqliteStatement& bind(int place, std::int64_t value);
  SqliteStatement& bind(int place, std::string_view text);
  /// The bytes must live until the statement has run.
  SqliteStatement& bind(int place, std::span<const std::uint8_t> blob);

  /// True while there is a row. Throws SqliteError.
  bool step();
  /// Runs a statement without rows and makes it ready to run again.
  void run();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  /// Views are good until the next step() or reset().
  [[nodiscard]] std::string_view text(int column) const;
  [[nodiscard]] std::span<const std::uint8_t> blob(int column) const;

 private:
  friend class SqliteDatabase;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  std::string file_;
};

/// One connection to one file. Every error message begins with the file's name.
class SqliteDatabase {
 public:
  enum class Mode : std::uint8_t {
    read,       // an existing file, never written
    immutable,  // the same on a medium where nothing can be written, not even a lock
    write,      // created if missing
  };
  SqliteDatabase(const std::filesystem::path& path, Mode mode);

  void execute(const std::string& sql);
  [[nodiscard]] SqliteStatement prepare(std::string_view sql) const;
  /// First column of the first row, 0 without a row; for pragmas and counts.
  [[nodiscard]] std::int64_t integer(std::string_view sql) const;
  [[nodiscard]] std::string text(std::string_view sql) const;
  [[nodiscard]] bool in_transaction() const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::unique_ptr<sqlite3, Close> connection_;
  std::string file_;
};

}  // namespace flogmap
