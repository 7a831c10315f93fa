// GET /frames/{left|right|disparity}/latest
#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/picture_encoding.hpp"

namespace flogmap {
namespace {

ImageStream requested_stream(const std::string& name) {
  if (name == "left") return ImageStream::left;
  if (name == "right") return ImageStream::right;
  if (name == "disparity") return ImageStream::disparity;
  throw RefusedRequest(404, "no-such-stream", "streams are left, right and disparity", "stream");
}

ApiAnswer get_latest(const ApiRequest& request, ServerState& state) {
  const ImageStream stream = requested_stream(request.captures.at(0));
  if (state.control.state() == SessionState::stored) {
    throw RefusedRequest(404, "no-pictures",
                         "a stored map has no camera; its views are under maps/{id}/views");
  }
  const auto width = integer_parameter(request, "max_width", 0, 0, 65536);
  state.pictures_asked_at = std::chrono::steady_clock::now();
  const PictureKey key = picture_key({stream, 0, static_cast<int>(width)});
  return ApiJob([pictures = state.pictures, key] {
    const auto picture = encode_picture(pictures, key);
    if (!picture) return problem(503, "no-picture-yet", "no frame has been processed yet");
    ApiResponse response;
    response.content_type = picture->media_type;
    response.headers.emplace_back("Flogmap-Time-Ns", std::to_string(picture->timestamp_ns));
    response.body = to_shared(picture->data);
    return response;
  });
}

}  // namespace

std::vector<Route> frame_routes() {
  return {{Method::get, "/api/v1/frames/{}/latest", Role::view, get_latest}};
}

}  // namespace flogmap
