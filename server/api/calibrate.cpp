// GET /calibrate, /calibrate/{left|right}; POST /calibrate:solve :restart. Only there while `flogmap
// calibrate` runs.
#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/calibration_desk.hpp"
#include "server/picture_encoding.hpp"

namespace flogmap {
namespace {

CalibrationDesk& desk_of(ServerState& state) {
  if (state.info.desk == nullptr)
    throw RefusedRequest(404, "not-calibrating", "nothing is being calibrated; see flogmap calibrate --help",
                         "path");
  return *state.info.desk;
}

ApiAnswer get_state(const ApiRequest&, ServerState& state) {
  return json_response(desk_of(state).state_json());
}

ApiAnswer get_picture(const ApiRequest& request, ServerState& state) {
  const std::string& side = request.captures.at(0);
  if (side != "left" && side != "right")
    throw RefusedRequest(404, "no-such-picture", "pictures are left and right", "side");
  const ImageStream stream = side == "left" ? ImageStream::left : ImageStream::right;
  return ApiJob([frame = desk_of(state).pictures(), key = picture_key({stream, 0, 0})] {
    const auto picture = encode_picture({frame ? frame->timestamp_ns : 0, frame, nullptr}, key);
    if (!picture) return problem(503, "no-picture-yet", "no pair has been taken yet");
    ApiResponse response;
    response.content_type = picture->media_type;
    response.body = to_shared(picture->data);
    return response;
  });
}

ApiAnswer post_solve(const ApiRequest&, ServerState& state) {
  CalibrationDesk& desk = desk_of(state);
  if (!desk.solve()) return problem(409, "too-few-pairs", "too few pairs have been kept to calibrate from");
  return json_response(desk.state_json(), 202);
}

ApiAnswer post_restart(const ApiRequest&, ServerState& state) {
  desk_of(state).restart();
  return json_response(desk_of(state).state_json(), 202);
}

}  // namespace

std::vector<Route> calibrate_routes() {
  return {{Method::get, "/api/v1/calibrate", Role::view, get_state},
          {Method::get, "/api/v1/calibrate/{}", Role::view, get_picture},
          {Method::post, "/api/v1/calibrate:solve", Role::control, post_solve},
          {Method::post, "/api/v1/calibrate:restart", Role::control, post_restart}};
}

}  // namespace flogmap
