#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/mcap/contents.hpp"
#include "camera/mcap/stamped_pairs.hpp"
#include "camera/mcap/topics.hpp"

namespace flogmap::mcap {

/// Where the pictures of two cameras lie in a file, and the calibration beside them.
class CameraMessages {
 public:
  /// `where` is FILE, a folder with one file, or FILE,LEFT_TOPIC,RIGHT_TOPIC. Throws std::runtime_error in
  /// one line where the file is no MCAP file or which topics are meant is not clear.
  explicit CameraMessages(const std::string& where);

  [[nodiscard]] const std::string& file() const { return file_.path(); }
  [[nodiscard]] const std::string& topic(Side side) const;
  /// In words, empty: the file is whole.
  [[nodiscard]] const std::string& damage() const { return contents_.damage; }
  /// True once a message was found whose stamp is not set; it counts as taken when it was recorded.
  [[nodiscard]] bool lacks_stamps() const { return lacks_stamps_; }
  /// How many pairs there can be; nothing where the file does not say.
  [[nodiscard]] std::optional<std::int64_t> num_pairs() const;

  /// Those with pictures of the two, by when they were recorded.
  [[nodiscard]] const std::vector<Extent>& extents() const { return extents_; }

  /// Calls for each picture in an extent, as it lies there; `problem` is empty, or says that this one is no
  /// such message. Returns why the extent cannot be read, empty if it can.
  [[nodiscard]] std::string load(
      const Extent& extent,
      const std::function<void(Side, StampedMessage, const std::string& problem)>& call);

  /// By the first camera_info beside each of the pictures' topics; nothing where there is none, or none that
  /// was calibrated. Throws std::runtime_error naming file, topic and field if it makes no sense.
  [[nodiscard]] std::optional<StereoCalibration> calibration();

 private:
  void find_channels();
  [[nodiscard]] std::vector<Topic> readable_topics() const;
  [[nodiscard]] std::optional<MessageKind> kind_of(const Channel& channel) const;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> first_message(const Topic& topic);

  FileBytes file_;
  Contents contents_;
  TopicPair topics_;
  std::map<std::uint16_t, std::pair<Side, MessageKind>> channels_;  // of the two topics
  std::vector<Extent> extents_;
  bool lacks_stamps_ = false;
};

}  // namespace flogmap::mcap
