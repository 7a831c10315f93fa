// Reading what a request asks for. Each throws a BadParameter, which becomes a 400 that names the parameter.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "server/http_values.hpp"
#include "server/server_state.hpp"
#include "server/tile_key.hpp"

namespace flogmap {

/// An impossible request; carries the response to it.
class RefusedRequest : public std::runtime_error {
 public:
  RefusedRequest(int status, std::string_view code, const std::string& detail,
                 std::string_view parameter = {})
      : std::runtime_error(detail), response_(problem(status, code, detail, parameter)) {}
  [[nodiscard]] const ApiResponse& response() const { return response_; }

 private:
  ApiResponse response_;
};

/// The map that the first capture names: 404 if there is none, 503 while the live one has not begun.
ServedMap& requested_map(const ApiRequest& request, ServerState& state);

double required_number(const ApiRequest& request, std::string_view name);
std::optional<double> optional_number(const ApiRequest& request, std::string_view name);
std::int64_t integer_parameter(const ApiRequest& request, std::string_view name, std::int64_t fallback,
                               std::int64_t least, std::int64_t most);
std::int64_t parse_integer(std::string_view text, std::string_view name, std::int64_t least,
                           std::int64_t most);
double parse_number(std::string_view text, std::string_view name);

/// "x_min,y_min,x_max,y_max" metres.
std::optional<Bounds> bbox_parameter(const ApiRequest& request);

/// A layer id, or nothing for "fused".
std::optional<int> parse_layer(std::string_view text, const MapInfo& info);

/// What the parameters style and palette ask for.
PictureChoice picture_choice(const ApiRequest& request, std::optional<int> layer);

/// Strong tag "<epoch>-<rev>-<representation>", quotes included.
std::string make_etag(std::string_view epoch, std::uint64_t revision, std::string_view representation);

/// The tag of an answer that follows from a map, a request and the options alone.
std::string etag_of(const ServedMap& map, const ApiRequest& request, const ServeOptions& options);
/// Likewise, if it shows the path or the views, which may change without a revision.
std::string etag_with_path(const ServedMap& map, const ApiRequest& request, const ServeOptions& options);
/// The tag of a document that does not belong to one map: from its contents.
std::string etag_of_text(std::string_view text);

/// The client has this already: saves the work of making it again.
bool is_known(const ApiRequest& request, std::string_view etag);
/// What finished() makes a 304 of.
ApiResponse nothing_new(std::string etag);

}  // namespace flogmap
