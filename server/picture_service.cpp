#include "server/picture_service.hpp"

#include <chrono>
#include <utility>

#include "server/picture_encoding.hpp"

namespace flogmap {

using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds kAskedLately{5};

}  // namespace

PictureService::PictureService(ServerState& state, Viewers& viewers, Post post)
    : state_(state), viewers_(viewers), post_(std::move(post)) {}

void PictureService::offer() {
  const auto now = steady_clock::now();
  wanted_ = viewers_.any_picture_wish() || now - state_.pictures_asked_at < kAskedLately;
  if (encoding_ || !state_.pictures.frame) return;
  const auto keys = viewers_.wanted_pictures(state_.pictures.timestamp_ns, now);
  if (!keys.empty()) encode(*keys.begin());
}

void PictureService::encode(PictureKey key) {
  encoding_ = encoder_.submit([this, key, pictures = state_.pictures] {
    const auto picture = encode_picture(pictures, key);
    const Bytes message = picture ? to_shared(encode_image(*picture)) : nullptr;
    post_([this, key, time_ns = pictures.timestamp_ns, message] {
      encoding_ = false;
      viewers_.deliver_picture(key, time_ns, message, steady_clock::now());
      viewers_.pump_all();
      offer();
    });
  });
}

}  // namespace flogmap
