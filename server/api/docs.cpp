// GET /openapi.yaml, /docs
#include "server/api/docs.hpp"

#include <yaml-cpp/yaml.h>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string text_of(const YAML::Node& node) { return node && node.IsScalar() ? escaped(node.Scalar()) : ""; }

/// Follows "#/components/parameters/id".
YAML::Node resolved(const YAML::Node& root, const YAML::Node& node) {
  if (!node.IsMap() || !node["$ref"]) return node;
  std::string path = node["$ref"].Scalar().substr(2) + "/";
  YAML::Node at = YAML::Clone(root);
  for (std::size_t end; (end = path.find('/')) != std::string::npos; path.erase(0, end + 1)) {
    at.reset(at[path.substr(0, end)]);
  }
  return at;
}

/// "png | pb | json" or "integer".
std::string type_of(const YAML::Node& schema) {
  if (!schema || !schema.IsMap()) return "";
  if (schema["enum"]) {
    std::string all;
    for (const auto& value : schema["enum"]) all += (all.empty() ? "" : " | ") + text_of(value);
    return all;
  }
  return text_of(schema["type"]);
}

std::string parameters_html(const YAML::Node& root, const YAML::Node& operation) {
  std::string html;
  for (const auto& given : operation["parameters"]) {
    const YAML::Node parameter = resolved(root, given);
    html += "<tr><td><code>" + text_of(parameter["name"]) + "</code><td>" + text_of(parameter["in"]) +
            "<td>" + type_of(parameter["schema"]) + "<td>" + text_of(parameter["description"]);
  }
  return html.empty() ? html : "<table><tr><th>parameter<th>in<th>values<th>" + html + "</table>";
}

std::string responses_html(const YAML::Node& root, const YAML::Node& operation) {
  std::string html;
  for (const auto& response : operation["responses"]) {
    const YAML::Node answer = resolved(root, response.second);
    std::string types;
    for (const auto& content : answer["content"])
      types += (types.empty() ? "" : ", ") + text_of(content.first);
    html += "<tr><td>" + text_of(response.first) + "<td>" + text_of(answer["description"]) + "<td>" + types;
  }
  return "<table><tr><th>status<th>means<th>type" + html + "</table>";
}

std::string operation_html(const YAML::Node& root, const std::string& path, const std::string& method,
                           const YAML::Node& operation) {
  return "<section><h2><b class=" + method + ">" + method + "</b> <code>" + escaped(path) +
         "</code></h2><p>" + text_of(operation["summary"]) + ". " + text_of(operation["description"]) +
         "</p>" + parameters_html(root, operation) + responses_html(root, operation) + "</section>";
}

ApiAnswer get_openapi(const ApiRequest&, ServerState&) {
  ApiResponse response;
  response.content_type = "application/yaml";
  response.cache_control = "no-cache";
  response.body = to_shared(std::string(openapi_yaml()));
  response.etag = etag_of_text(*response.body);
  return response;
}

ApiAnswer get_docs(const ApiRequest&, ServerState&) {
  static const Bytes page = to_shared(openapi_as_html(openapi_yaml()));
  ApiResponse response;
  response.content_type = "text/html; charset=utf-8";
  response.cache_control = "no-cache";
  response.body = page;
  response.etag = etag_of_text(*page);
  return response;
}

ApiAnswer get_style(const ApiRequest&, ServerState&) {
  ApiResponse response;
  response.content_type = "text/css; charset=utf-8";
  response.cache_control = "no-cache";
  response.body = to_shared(
      ":root{color-scheme:light dark;font:16px/1.5 system-ui,sans-serif}body{max-width:60rem;margin:2rem "
      "auto;"
      "padding:0 1rem}h2{font-size:1rem;margin:2rem 0 .25rem}b{text-transform:uppercase;padding:.1rem .5rem;"
      "border-radius:.3rem;color:#fff;background:#2b6cb0}b.post{background:#2f855a}b.patch{background:#"
      "975a16}"
      "table{border-collapse:collapse;margin:.5rem 0;font-size:.9rem}td,th{text-align:left;padding:.2rem "
      ".8rem .2rem 0;"
      "border-bottom:1px solid #8884;vertical-align:top}");
  response.etag = etag_of_text(*response.body);
  return response;
}

}  // namespace

std::string openapi_as_html(std::string_view yaml) {
  const YAML::Node root = YAML::Load(std::string(yaml));
  std::string html =
      "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">"
      "<title>flogmap: interface</title><link rel=stylesheet href=/docs.css><h1>flogmap: interface</h1><p>" +
      text_of(root["info"]["description"]) + "<p>As <a href=/openapi.yaml>OpenAPI 3.1</a>.";
  for (const auto& path : root["paths"]) {
    for (const auto& operation : path.second) {
      html += operation_html(root, path.first.Scalar(), operation.first.Scalar(), operation.second);
    }
  }
  return html;
}

std::vector<Route> docs_routes() {
  return {{Method::get, "/openapi.yaml", Role::none, get_openapi},
          {Method::get, "/docs", Role::none, get_docs},
          {Method::get, "/docs.css", Role::none, get_style}};
}

}  // namespace flogmap
