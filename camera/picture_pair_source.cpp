#include "camera/picture_pair_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/low_bits.hpp"
#include "camera/picture_files.hpp"

namespace flogmap {
namespace {

std::string size_text(const Picture& picture) {
  return std::to_string(picture.width) + "x" + std::to_string(picture.height);
}

}  // namespace

std::int64_t time_at(std::size_t picture, double rate_hz) {
  return std::llround(1e9 * static_cast<double>(picture) / rate_hz);
}

std::string assumed_rate(double rate_hz) {
  char text[80];
  std::snprintf(text, sizeof text, "pictures are taken to come at %g Hz (--frame-rate)", rate_hz);
  return text;
}

PicturePairSource::PicturePairSource(std::string spec, PicturePairList list, bool loop)
    : spec_(std::move(spec)), list_(std::move(list)), loop_(loop) {
  if (list_.pairs.empty()) {
    const std::string& why = list_.skipped.last_reason;
    throw std::runtime_error(spec_ + ": no stereo pair" + (why.empty() ? "" : "; " + why));
  }
  find_picture_size();
  find_unused_bits();
  if (list_.calibration) fit_resolution(*list_.calibration, width_px_, height_px_, spec_);
}

void PicturePairSource::find_picture_size() {
  constexpr std::size_t kTries = 20;
  std::string problem;
  for (std::size_t i = 0; i < std::min(kTries, list_.pairs.size()); ++i) {
    const ReadPicture left = read_picture(list_.pairs[i].left);
    const ReadPicture right = read_picture(list_.pairs[i].right);
    problem = left.problem.empty() ? right.problem : left.problem;
    if (!problem.empty()) continue;
    if (left.picture.width != right.picture.width || left.picture.height != right.picture.height) {
      throw std::runtime_error(spec_ + ": left and right pictures must have one size, got " +
                               size_text(left.picture) + " (" + list_.pairs[i].left.string() + ") and " +
                               size_text(right.picture) + " (" + list_.pairs[i].right.string() + ")");
    }
    width_px_ = left.picture.width;
    height_px_ = left.picture.height;
    return;
  }
  throw std::runtime_error(spec_ + ": no readable pair; " + problem);
}

/// By pictures from all over the recording, for its start may be dark.
void PicturePairSource::find_unused_bits() {
  constexpr std::size_t kLooks = 8;
  const std::size_t step = std::max<std::size_t>(1, list_.pairs.size() / kLooks);
  std::optional<int> unused;
  for (std::size_t i = 0; i < list_.pairs.size() && unused != 0; i += step) {
    for (const auto& file : {list_.pairs[i].left, list_.pairs[i].right}) {
      const ReadPicture look = read_picture(file);
      if (look.problem.empty()) unused = std::min(unused.value_or(16), unused_bits(look.picture));
    }
  }
  unused_bits_ = unused.value_or(0);
  if (unused_bits_ == 0) return;
  list_.assumed += (list_.assumed.empty() ? "" : "; ") + std::string("the 16-bit pictures use only ") +
                   std::to_string(16 - unused_bits_) + " bits and are taken as such";
}

std::optional<StereoFrame> PicturePairSource::read(const PicturePair& pair) {
  StereoFrame frame{pair.timestamp_ns, {}, {}};
  for (const auto& [file, picture] :
       {std::pair(&pair.left, &frame.left), std::pair(&pair.right, &frame.right)}) {
    ReadPicture result = read_picture(*file);
    if (result.problem.empty() &&
        (result.picture.width != width_px_ || result.picture.height != height_px_)) {
      result.problem = file->string() + ": " + size_text(result.picture) + " px, the others are " +
                       std::to_string(width_px_) + "x" + std::to_string(height_px_);
    }
    if (!result.problem.empty()) {
      list_.skip(std::move(result.problem));
      return std::nullopt;
    }
    *picture = std::move(result.picture);
    shift_up(*picture, unused_bits_);
  }
  return frame;
}

std::optional<StereoFrame> PicturePairSource::next() {
  bool wrapped = false;
  while (!stopped_) {
    if (position_ == list_.pairs.size()) {
      if (!loop_ || wrapped) return std::nullopt;  // a whole round without a readable pair ends it too
      wrapped = true;
      position_ = 0;
    }
    if (auto frame = read(list_.pairs[position_++])) return frame;
  }
  return std::nullopt;
}

SourceInfo PicturePairSource::info() const {
  return {.spec = spec_,
          .live = false,
          .endless = false,
          .num_frames = static_cast<std::int64_t>(list_.pairs.size()),
          .first_timestamp_ns = list_.pairs.front().timestamp_ns,
          .last_timestamp_ns = list_.pairs.back().timestamp_ns,
          .assumed = list_.assumed};
}

bool PicturePairSource::seek(std::int64_t timestamp_ns) {
  const auto at =
      std::lower_bound(list_.pairs.begin(), list_.pairs.end(), timestamp_ns,
                       [](const PicturePair& pair, std::int64_t t) { return pair.timestamp_ns < t; });
  position_ = static_cast<std::size_t>(at - list_.pairs.begin());
  return true;
}

}  // namespace flogmap
