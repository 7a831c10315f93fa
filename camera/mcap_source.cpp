#include "camera/mcap_source.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/low_bits.hpp"
#include "camera/mcap/camera_messages.hpp"
#include "camera/mcap/image_message.hpp"
#include "camera/mcap/stamped_pairs.hpp"

namespace flogmap {
namespace {

using mcap::CameraMessages;
using mcap::Extent;
using mcap::StampedMessage;
using mcap::StampedPair;

constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min();

std::string size_text(const Picture& picture) {
  return std::to_string(picture.width) + "x" + std::to_string(picture.height);
}

std::string time_text(std::int64_t time_ns) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  char text[48];
  std::snprintf(text, sizeof text, "%lld.%09lld s", static_cast<long long>(time_ns / kNsPerSecond),
                static_cast<long long>(time_ns % kNsPerSecond));
  return text;
}

ReadPicture decode(const StampedMessage& message) {
  const auto image = mcap::read_image_message(message.kind, message.bytes);
  return image ? mcap::decode_image(*image) : ReadPicture{{}, "cut off"};
}

class McapSource final : public StereoSource {
 public:
  explicit McapSource(McapRecording recording)
      : recording_(std::move(recording)),
        messages_(recording_.where),
        told_extents_(messages_.extents().size()),
        pairs_(tolerance_ns(), [this](Side side, std::int64_t stamp_ns, const std::string& reason) {
          skip(side, stamp_ns, reason);
        }) {
    if (!recording_.calibration && recording_.reads_calibration)
      recording_.calibration = messages_.calibration();
    find_picture_size();
    find_unused_bits();
    last_ns_ = std::max(first_ns_, find_last());
    if (recording_.calibration)
      fit_resolution(*recording_.calibration, width_px_, height_px_, messages_.file());
    start_at(0, kBeforeAll);
    seen_until_ns_ = told_until_ns_ = kBeforeAll;  // what was skipped while looking is told when it is read
    told_extents_.assign(told_extents_.size(), false);
    skipped_ = {};
    skew_ = {};
  }

  std::optional<StereoFrame> next() override {
    bool wrapped = false;
    while (!stopped_) {
      if (const auto pair = next_pair()) {
        if (auto frame = read(*pair)) return frame;
        continue;
      }
      if (!recording_.loop || wrapped) return std::nullopt;  // a whole round without a pair ends it, too
      wrapped = true;
      start_at(0, kBeforeAll);
    }
    return std::nullopt;
  }

  void stop() override { stopped_ = true; }

  [[nodiscard]] SourceInfo info() const override {
    std::string assumed = messages_.damage();
    const auto assume = [&](const std::string& what) { assumed += (assumed.empty() ? "" : "; ") + what; };
    if (messages_.lacks_stamps()) assume("pictures without a stamp count as taken when they were recorded");
    if (unused_bits_ > 0) {
      assume("the 16-bit pictures use only " + std::to_string(16 - unused_bits_) +
             " bits and are taken as such");
    }
    return {.spec = recording_.spec,
            .live = false,
            .endless = false,
            .num_frames = messages_.num_pairs(),
            .first_timestamp_ns = first_ns_,
            .last_timestamp_ns = last_ns_,
            .assumed = assumed};
  }

  [[nodiscard]] std::optional<StereoCalibration> calibration() const override {
    return recording_.calibration;
  }
  [[nodiscard]] SkippedFrames skipped() const override { return skipped_; }
  [[nodiscard]] std::optional<PairSkew> skew() const override {
    PairSkew all = skew_;
    all.allowed_ms = recording_.max_skew_ms;
    return all;
  }

  bool seek(std::int64_t timestamp_ns) override {
    start_at(extent_before(timestamp_ns), timestamp_ns);
    return true;
  }

 private:
  [[nodiscard]] std::int64_t tolerance_ns() const {
    constexpr double kNsPerMs = 1e6;
    return static_cast<std::int64_t>(kNsPerMs * recording_.max_skew_ms);
  }

  /// What lies before the newest picture seen was told when it was read for the first time.
  void skip(Side side, std::int64_t stamp_ns, const std::string& reason) {
    if (stamp_ns <= told_until_ns_ || stamp_ns < from_ns_) return;
    ++skipped_.count;
    skipped_.last_reason =
        messages_.file() + ": " + messages_.topic(side) + " at " + time_text(stamp_ns) + ": " + reason;
  }

  void start_at(std::size_t extent, std::int64_t from_ns) {
    pairs_.clear();
    position_ = extent;
    from_ns_ = from_ns;
    told_until_ns_ = seen_until_ns_;
  }

  void add_extent(std::size_t index) {
    const Extent& extent = messages_.extents()[index];
    const std::string bad =
        messages_.load(extent, [&](Side side, StampedMessage message, const std::string& problem) {
          if (!problem.empty()) return skip(side, message.stamp_ns, problem);
          // The partner of a picture at the time sought may be a little older.
          const std::int64_t slack_ns = side == Side::left ? 0 : tolerance_ns();
          if (from_ns_ != kBeforeAll && message.stamp_ns < from_ns_ - slack_ns) return;
          seen_until_ns_ = std::max(seen_until_ns_, message.stamp_ns);
          pairs_.add(side, std::move(message));
        });
    if (bad.empty() || told_extents_[index]) return;
    told_extents_[index] = true;
    ++skipped_.count;
    skipped_.last_reason = messages_.file() + ": chunk at byte " + std::to_string(extent.offset) + ": " + bad;
  }

  std::optional<StampedPair> next_pair() {
    const std::vector<Extent>& extents = messages_.extents();
    while (!stopped_) {
      while (position_ < extents.size() && pairs_.wants_more(extents[position_].start_ns))
        add_extent(position_++);
      if (pairs_.empty()) return std::nullopt;
      auto pair = pairs_.take();
      if (!pair) continue;
      if (pair->left.stamp_ns > told_until_ns_)
        skew_.histogram.add(pair->right.stamp_ns - pair->left.stamp_ns);
      return pair;
    }
    return std::nullopt;
  }

  std::optional<StereoFrame> read(const StampedPair& pair) {
    StereoFrame frame{pair.left.stamp_ns, {}, {}};
    for (const Side side : {Side::left, Side::right}) {
      const StampedMessage& message = side == Side::left ? pair.left : pair.right;
      ReadPicture result = decode(message);
      const Picture& picture = result.picture;
      if (result.problem.empty() && (picture.width != width_px_ || picture.height != height_px_)) {
        result.problem = size_text(picture) + " px, the others are " + std::to_string(width_px_) + "x" +
                         std::to_string(height_px_);
      }
      if (!result.problem.empty()) {
        skip(side, message.stamp_ns, result.problem);
        return std::nullopt;
      }
      shift_up(result.picture, unused_bits_);
      (side == Side::left ? frame.left : frame.right) = std::move(result.picture);
    }
    return frame;
  }

  void find_picture_size();
  void find_unused_bits();
  [[nodiscard]] std::int64_t find_last();
  [[nodiscard]] std::optional<std::int64_t> first_stamp(const Extent& extent);
  [[nodiscard]] std::size_t extent_before(std::int64_t timestamp_ns);

  McapRecording recording_;
  CameraMessages messages_;
  std::vector<bool> told_extents_;  // those whose damage is counted
  mcap::StampedPairs pairs_;
  std::size_t position_ = 0;           // of the next extent
  std::int64_t from_ns_ = kBeforeAll;  // as sought
  std::int64_t seen_until_ns_ = kBeforeAll, told_until_ns_ = kBeforeAll;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  int width_px_ = 0, height_px_ = 0;  // of the first readable pair; others are skipped
  int unused_bits_ = 0;               // see low_bits.hpp; the same for all pictures
  SkippedFrames skipped_;
  PairSkew skew_;
  std::atomic<bool> stopped_ = false;
};

void McapSource::find_picture_size() {
  constexpr int kTries = 20;
  std::string problem;
  for (int i = 0; i < kTries; ++i) {
    const auto pair = next_pair();
    if (!pair && i == 0) {
      const std::string& why = skipped_.last_reason;
      throw std::runtime_error(messages_.file() + ": no stereo pair" + (why.empty() ? "" : "; " + why));
    }
    if (!pair) break;
    if (i == 0) first_ns_ = pair->left.stamp_ns;
    const ReadPicture left = decode(pair->left), right = decode(pair->right);
    problem = left.problem.empty() ? right.problem : left.problem;
    if (!problem.empty()) continue;
    width_px_ = left.picture.width;
    height_px_ = left.picture.height;
    if (right.picture.width == width_px_ && right.picture.height == height_px_) return;
    throw std::runtime_error(messages_.file() + ": left and right pictures must have one size, got " +
                             size_text(left.picture) + " (" + messages_.topic(Side::left) + ") and " +
                             size_text(right.picture) + " (" + messages_.topic(Side::right) + ")");
  }
  throw std::runtime_error(messages_.file() + ": no readable pair; " + problem);
}

/// By pictures from all over the recording, for its start may be dark.
void McapSource::find_unused_bits() {
  constexpr std::size_t kLooks = 8;
  const std::size_t step = std::max<std::size_t>(1, messages_.extents().size() / kLooks);
  std::optional<int> unused;
  for (std::size_t i = 0; i < messages_.extents().size() && unused != 0; i += step) {
    start_at(i, kBeforeAll);
    const auto pair = next_pair();
    if (!pair) break;
    for (const StampedMessage* message : {&pair->left, &pair->right}) {
      const ReadPicture look = decode(*message);
      if (look.problem.empty()) unused = std::min(unused.value_or(16), unused_bits(look.picture));
    }
  }
  unused_bits_ = unused.value_or(0);
}

std::int64_t McapSource::find_last() {
  std::int64_t last_ns = kBeforeAll;
  const std::vector<Extent>& extents = messages_.extents();
  for (std::size_t i = extents.size(); i-- > 0 && last_ns == kBeforeAll;) {
    (void)messages_.load(extents[i], [&](Side side, const StampedMessage& message, const std::string& bad) {
      if (side == Side::left && bad.empty()) last_ns = std::max(last_ns, message.stamp_ns);
    });
  }
  return last_ns;
}

std::optional<std::int64_t> McapSource::first_stamp(const Extent& extent) {
  std::optional<std::int64_t> first;
  (void)messages_.load(extent, [&](Side, const StampedMessage& message, const std::string& problem) {
    if (problem.empty()) first = std::min(first.value_or(message.stamp_ns), message.stamp_ns);
  });
  return first;
}

/// Where reading must begin so that no pair from this time on is missed.
std::size_t McapSource::extent_before(std::int64_t timestamp_ns) {
  const std::vector<Extent>& extents = messages_.extents();
  std::size_t low = 0, high = extents.size();  // those before `low` begin early enough
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const auto first = first_stamp(extents[middle]);
    if (first && *first <= timestamp_ns)
      low = middle + 1;
    else
      high = middle;  // unreadable ones, too: to begin early only takes time
  }
  // Chunks overlap, of recorders that fill several at once; and a pair may lie across two.
  constexpr std::size_t kFewest = 2, kMost = 16;
  std::size_t steps = 0;
  for (; low > 0 && steps < kMost; ++steps) {
    if (steps >= kFewest && extents[low - 1].end_ns < extents[low].start_ns) break;
    --low;
  }
  return low;
}

}  // namespace

std::unique_ptr<StereoSource> open_mcap(McapRecording recording) {
  return std::make_unique<McapSource>(std::move(recording));
}

}  // namespace flogmap
