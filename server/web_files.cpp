#include "server/web_files.hpp"

#include <libdeflate.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

namespace flogmap {
namespace {

constexpr std::string_view kNotBuilt =
    "<!doctype html><meta charset=utf-8><title>flogmap</title>"
    "<h1>The page is not built</h1><p>Run <code>scripts/build</code>, or give <code>--web-root</code>. "
    "The map is served all the same: see <a href=\"/docs\">/docs</a>.";

/// zlib's Adler-32 (RFC 1950) and the length, in hexadecimal: enough to tell two builds of a file apart.
std::string fingerprint(const std::string& bytes) {
  const std::uint32_t adler = libdeflate_adler32(1, bytes.data(), bytes.size());
  const std::uint32_t crc = libdeflate_crc32(0, bytes.data(), bytes.size());
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x-%zx", adler, crc, bytes.size());
  return text.data();
}

Bytes gzipped(const std::string& bytes) {
  using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
  const Compressor compressor(libdeflate_alloc_compressor(9), libdeflate_free_compressor);
  std::string out(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()), '\0');
  out.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
  return out.size() + out.size() / 10 < bytes.size() ? to_shared(std::move(out)) : nullptr;
}

/// "assets/index-B8d1kq2f.js": the bundler puts a hash of the contents before the extension.
bool has_hashed_name(std::string_view path) {
  const auto dot = path.rfind('.');
  const auto dash = path.rfind('-', dot);
  return path.find("/assets/") != std::string_view::npos && dot != std::string_view::npos &&
         dash != std::string_view::npos && dot - dash > 8;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::string_view content_type_of(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".txt", "text/plain; charset=utf-8"},
      {".yaml", "application/yaml"},
      {".glb", "model/gltf-binary"},
  }};
  for (const auto& [extension, type] : kTypes) {
    if (path.ends_with(extension)) return type;
  }
  return "application/octet-stream";
}

WebFiles::WebFiles(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!it->is_regular_file(error)) continue;
    std::string path = fs::relative(it->path(), folder).generic_string();
    add(path.insert(0, 1, '/'), read_file(it->path()));
  }
}

void WebFiles::add(const std::string& path, std::string bytes) {
  File file;
  file.content_type = content_type_of(path);
  const std::string print = fingerprint(bytes);
  file.etag.append("\"").append(print).append("\"");
  file.gzipped_etag.append("\"").append(print).append("-gz\"");
  file.hashed_name = has_hashed_name(path);
  const bool text = file.content_type.find("text") != std::string::npos ||
                    file.content_type.find("json") != std::string::npos || path.ends_with(".svg");
  if (text) file.gzipped = gzipped(bytes);
  file.bytes = to_shared(std::move(bytes));
  files_[path] = std::move(file);
}

ApiResponse WebFiles::answer(const ApiRequest& request) const {
  const std::string path = request.path == "/" ? "/index.html" : request.path;
  const auto found = files_.find(path);
  if (found == files_.end()) {
    if (request.path != "/") return problem(404, "not-found", "there is nothing at " + request.path);
    ApiResponse response;
    response.content_type = "text/html; charset=utf-8";
    response.body = to_shared(std::string(kNotBuilt));
    return response;
  }
  const File& file = found->second;
  const bool zip = file.gzipped && request.accept_encoding.find("gzip") != std::string::npos;
  ApiResponse response;
  response.content_type = file.content_type;
  response.body = zip ? file.gzipped : file.bytes;
  response.etag = zip ? file.gzipped_etag : file.etag;
  response.cache_control = file.hashed_name ? "public, max-age=31536000, immutable" : "no-cache";
  if (file.gzipped) response.headers.emplace_back("Vary", "Accept-Encoding");
  if (zip) response.headers.emplace_back("Content-Encoding", "gzip");
  return response;
}

}  // namespace flogmap
