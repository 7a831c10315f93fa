#pragma once

#include <map>
#include <string>
#include <string_view>

#include "server/http_values.hpp"

namespace flogmap {

/// The built page, read into memory once. Only paths that were read can be asked for, so none leads out of
/// it.
class WebFiles {
 public:
  /// All files below `folder`; none if it does not exist.
  explicit WebFiles(const std::string& folder);

  /// The file at a path ("/" is index.html); 404 as a problem if there is none.
  [[nodiscard]] ApiResponse answer(const ApiRequest& request) const;

  [[nodiscard]] bool empty() const { return files_.empty(); }
  [[nodiscard]] bool holds(std::string_view path) const { return files_.find(path) != files_.end(); }

 private:
  struct File {
    Bytes bytes;
    Bytes gzipped;  // null where that is no shorter
    std::string content_type;
    std::string etag;
    std::string gzipped_etag;
    bool hashed_name = false;  // its contents never change
  };

  void add(const std::string& path, std::string bytes);

  std::map<std::string, File, std::less<>> files_;
};

/// "text/html; charset=utf-8" of "index.html".
std::string_view content_type_of(std::string_view path);

}  // namespace flogmap
