#include "camera/video_source.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "camera/calibration/calibration_checks.hpp"

namespace flogmap {
namespace {

/// One file, frame by frame.
class Video {
 public:
  Video(const std::string& spec, const std::string& file) : file_(file) {
    if (!std::filesystem::is_regular_file(file)) throw std::runtime_error(spec + ": no such file: " + file);
    if (!capture_.open(file, backend())) throw std::runtime_error(spec + ": not a readable video: " + file);
    rate_hz_ = capture_.get(cv::CAP_PROP_FPS);
    if (!(rate_hz_ > 0.01 && rate_hz_ < 1000)) rate_hz_ = 30;  // some files do not say
  }

  [[nodiscard]] bool read(cv::Mat& frame) {
    if (!capture_.read(frame) || frame.depth() != CV_8U) return false;
    ++position_;
    return true;
  }
  [[nodiscard]] bool seek(std::int64_t frame) {
    if (!capture_.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(frame))) return false;
    position_ = frame;
    return true;
  }
  [[nodiscard]] std::int64_t position() const { return position_; }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::int64_t num_frames() const {
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    return count > 0 && count < 1e9 ? std::llround(count) : 0;  // 0: the file does not say
  }

 private:
  /// FFmpeg where OpenCV has it: asked for any, OpenCV tries one after the other, and each complains of a
  /// damaged file.
  static int backend() {
    const std::vector<cv::VideoCaptureAPIs> there = cv::videoio_registry::getStreamBackends();
    return std::find(there.begin(), there.end(), cv::CAP_FFMPEG) != there.end() ? cv::CAP_FFMPEG
                                                                                : cv::CAP_ANY;
  }

  std::string file_;
  cv::VideoCapture capture_;
  double rate_hz_ = 30;
  std::int64_t position_ = 0;  // of the next frame
};

Picture picture_from(const cv::Mat& frame) {
  Picture picture{frame.cols, frame.rows, frame.channels(), 8, {}};
  const std::size_t row_bytes = frame.cols * frame.elemSize();
  picture.bytes.resize(row_bytes * frame.rows);
  for (int y = 0; y < frame.rows; ++y)
    std::memcpy(picture.bytes.data() + y * row_bytes, frame.ptr(y), row_bytes);
  return picture;
}

class VideoSource final : public StereoSource {
 public:
  explicit VideoSource(VideoFiles files) : files_(std::move(files)), left_(files_.spec, files_.left) {
    if (!files_.right.empty()) right_ = std::make_unique<Video>(files_.spec, files_.right);
    const auto first = read_pair();
    if (!first) throw std::runtime_error(files_.spec + ": no readable frame");
    check_sizes(*first);
    if (!rewind()) throw std::runtime_error(files_.spec + ": cannot go back to the first frame");
    skipped_ = {};
  }

  std::optional<StereoFrame> next() override {
    if (stopped_) return std::nullopt;
    auto frame = read_pair();
    if (frame || !files_.loop || !rewind()) return frame;
    return read_pair();
  }

  void stop() override { stopped_ = true; }

  [[nodiscard]] SourceInfo info() const override {
    SourceInfo info{.spec = files_.spec,
                    .live = false,
                    .endless = false,
                    .num_frames = std::nullopt,
                    .first_timestamp_ns = 0,
                    .last_timestamp_ns = std::numeric_limits<std::int64_t>::max()};
    std::int64_t count = left_.num_frames();
    if (right_) count = std::min(count, right_->num_frames());
    if (count > 0) info.num_frames = count, info.last_timestamp_ns = time_of(count - 1);
    return info;
  }

  [[nodiscard]] std::optional<StereoCalibration> calibration() const override { return files_.calibration; }
  [[nodiscard]] SkippedFrames skipped() const override { return skipped_; }

  bool seek(std::int64_t timestamp_ns) override {
    const double frames =
        1e-9 * static_cast<double>(std::max<std::int64_t>(timestamp_ns, 0)) * left_.rate_hz();
    const auto frame = static_cast<std::int64_t>(std::ceil(frames - 1e-6));
    return left_.seek(frame) && (!right_ || right_->seek(frame));
  }

 private:
  [[nodiscard]] std::int64_t time_of(std::int64_t frame) const {
    return std::llround(1e9 * static_cast<double>(frame) / left_.rate_hz());
  }
  bool rewind() { return left_.seek(0) && (!right_ || right_->seek(0)); }

  std::optional<StereoFrame> read_pair() {
    const std::int64_t time_ns = time_of(left_.position());
    cv::Mat left, right;
    const bool has_left = left_.read(left);
    const bool has_right = right_ ? right_->read(right) : has_left;
    if (has_left != has_right) {
      skipped_ = {skipped_.count + 1,
                  (has_left ? right_->file() : left_.file()) + ": ends before the other video"};
    }
    if (!has_left || !has_right) return std::nullopt;
    if (right_) return StereoFrame{time_ns, picture_from(left), picture_from(right)};
    const int half = left.cols / 2;
    return StereoFrame{time_ns, picture_from(left.colRange(0, half)),
                       picture_from(left.colRange(half, 2 * half))};
  }

  void check_sizes(const StereoFrame& frame) {
    const int width = frame.left.width, height = frame.left.height;
    if (width != frame.right.width || height != frame.right.height) {
      throw std::runtime_error(files_.spec + ": left and right must have one size, got " +
                               std::to_string(width) + "x" + std::to_string(height) + " and " +
                               std::to_string(frame.right.width) + "x" + std::to_string(frame.right.height));
    }
    if (files_.calibration) fit_resolution(*files_.calibration, width, height, files_.spec);
  }

  VideoFiles files_;
  Video left_;
  std::unique_ptr<Video> right_;
  SkippedFrames skipped_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace

std::unique_ptr<StereoSource> open_video(VideoFiles files) {
  return std::make_unique<VideoSource>(std::move(files));
}

}  // namespace flogmap
