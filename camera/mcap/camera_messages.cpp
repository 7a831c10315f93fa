#include "camera/mcap/camera_messages.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include "camera/mcap/camera_info_message.hpp"
#include "camera/mcap/image_message.hpp"

namespace flogmap::mcap {
namespace {

namespace fs = std::filesystem;

struct Where {
  std::string file, left, right;  // topics may be empty
};

/// Topics hold no commas, files may.
Where parse_where(const std::string& where) {
  const std::size_t second = where.rfind(',');
  if (second == std::string::npos || fs::exists(where)) return {where, "", ""};
  const std::size_t first = second == 0 ? std::string::npos : where.rfind(',', second - 1);
  if (first == std::string::npos || second == first + 1 || second + 1 == where.size())
    throw std::runtime_error("mcap: must be FILE or FILE,LEFT_TOPIC,RIGHT_TOPIC, got '" + where + "'");
  return {where.substr(0, first), where.substr(first + 1, second - first - 1), where.substr(second + 1)};
}

/// A bag of ROS 2 is a folder, usually with one file.
std::string file_in(const std::string& path) {
  if (!fs::is_directory(path)) return path;
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (entry.path().extension() == ".mcap") files.insert(entry.path().string());
  if (files.size() == 1) return *files.begin();
  if (files.empty()) throw std::runtime_error(path + ": no .mcap file in this folder");
  throw std::runtime_error(path + ": holds " + std::to_string(files.size()) +
                           " .mcap files; name one of them, for instance " + *files.begin());
}

bool may_hold(const Extent& extent, std::uint16_t channel) {
  return extent.channels.empty() ||
         std::find(extent.channels.begin(), extent.channels.end(), channel) != extent.channels.end();
}

/// Where a stamp was never set, the time of recording.
bool set_stamp(StampedMessage& message, std::int64_t stamp_ns) {
  message.stamp_ns = stamp_ns;
  if (stamp_ns != 0) return true;
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  message.stamp_ns = static_cast<std::int64_t>(std::min(message.log_time_ns, kMost));
  return false;
}

}  // namespace

CameraMessages::CameraMessages(const std::string& where) : file_(file_in(parse_where(where).file)) {
  contents_ = read_contents(file_);
  const Where names = parse_where(where);
  topics_ = names.left.empty() ? choose_topics(readable_topics(), file())
                               : named_topics(readable_topics(), names.left, names.right, file());
  find_channels();
}

void CameraMessages::find_channels() {
  for (const auto& [id, channel] : contents_.channels) {
    const auto kind = kind_of(channel);
    if (!kind || kind->meaning == Meaning::camera_info) continue;
    if (channel.topic == topics_.left.name) channels_.insert({id, {Side::left, *kind}});
    if (channel.topic == topics_.right.name) channels_.insert({id, {Side::right, *kind}});
  }
  for (const Extent& extent : contents_.extents) {
    const bool wanted = std::any_of(channels_.begin(), channels_.end(),
                                    [&](const auto& entry) { return may_hold(extent, entry.first); });
    if (wanted) extents_.push_back(extent);
  }
}

const std::string& CameraMessages::topic(Side side) const {
  return side == Side::left ? topics_.left.name : topics_.right.name;
}

std::optional<MessageKind> CameraMessages::kind_of(const Channel& channel) const {
  const auto schema = contents_.schemas.find(channel.schema_id);
  if (schema == contents_.schemas.end()) return std::nullopt;
  return message_kind(schema->second.name, channel.message_encoding);
}

std::vector<Topic> CameraMessages::readable_topics() const {
  std::map<std::string, Topic> by_name;  // a topic has a channel for each of its publishers
  for (const auto& [id, channel] : contents_.channels) {
    if (const auto kind = kind_of(channel)) {
      by_name.try_emplace(channel.topic,
                          Topic{channel.topic, contents_.schemas.at(channel.schema_id).name, *kind});
    }
  }
  std::vector<Topic> topics;
  for (const auto& [name, topic] : by_name) topics.push_back(topic);
  return topics;
}

std::optional<std::int64_t> CameraMessages::num_pairs() const {
  if (contents_.num_messages.empty()) return std::nullopt;
  std::uint64_t left = 0, right = 0;
  for (const auto& [id, entry] : channels_) {
    const auto found = contents_.num_messages.find(id);
    if (found != contents_.num_messages.end()) (entry.first == Side::left ? left : right) += found->second;
  }
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::min({left, right, kMost}));
}

std::string CameraMessages::load(const Extent& extent,
                                 const std::function<void(Side, StampedMessage, const std::string&)>& call) {
  const ChunkBytes records = load_extent(file_, extent);
  for_each_message(records.bytes, [&](const Message& message) {
    const auto found = channels_.find(message.channel_id);
    if (found == channels_.end()) return;
    const auto& [side, kind] = found->second;
    StampedMessage stamped{0, message.log_time_ns, kind, {}};
    const auto image = read_image_message(kind, message.data);
    if (!set_stamp(stamped, image ? image->stamp_ns : 0) && image) lacks_stamps_ = true;
    if (image) stamped.bytes.assign(message.data.begin(), message.data.end());
    call(side, std::move(stamped), image ? "" : "cut off, or not what its type says");
  });
  return records.problem;
}

std::optional<std::vector<std::uint8_t>> CameraMessages::first_message(const Topic& topic) {
  for (const Extent& extent : contents_.extents) {
    std::set<std::uint16_t> channels;
    for (const auto& [id, channel] : contents_.channels)
      if (channel.topic == topic.name && may_hold(extent, id)) channels.insert(id);
    if (channels.empty()) continue;
    std::optional<std::vector<std::uint8_t>> found;
    for_each_message(load_extent(file_, extent).bytes, [&](const Message& message) {
      if (!found && channels.contains(message.channel_id))
        found.emplace(message.data.begin(), message.data.end());
    });
    if (found) return found;
  }
  return std::nullopt;
}

std::optional<StereoCalibration> CameraMessages::calibration() {
  const auto topics = info_topics(readable_topics(), topics_);
  if (!topics) return std::nullopt;
  std::vector<RosCameraInfo> infos;
  for (const Topic* topic : {&topics->left, &topics->right}) {
    const auto message = first_message(*topic);
    if (!message) return std::nullopt;
    const std::string origin = file() + ": " + topic->name;
    auto info = read_camera_info(topic->kind, *message, origin);
    if (!info) throw std::runtime_error(origin + ": not a readable " + topic->schema);
    if (!is_calibrated(*info)) return std::nullopt;
    infos.push_back(std::move(*info));
  }
  return ros_calibration(infos[0], infos[1], is_rectified(topics_.left.name));
}

}  // namespace flogmap::mcap
