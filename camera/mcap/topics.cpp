#include "camera/mcap/topics.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace flogmap::mcap {
namespace {

struct Sides {
  std::string_view left, right;
};
constexpr std::array kSides{
    Sides{"left", "right"}, Sides{"Left", "Right"},  Sides{"LEFT", "RIGHT"},      Sides{"cam0", "cam1"},
    Sides{"CAM0", "CAM1"},  Sides{"cam_0", "cam_1"}, Sides{"camera0", "camera1"}, Sides{"infra1", "infra2"},
};

bool is_picture(const Topic& topic) { return topic.kind.meaning != Meaning::camera_info; }

/// What comes before the last "/".
std::string parent_of(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? "" : topic.substr(0, slash);
}

/// Compressed pictures lie below the name of the raw ones.
std::string without_transport(const Topic& topic) {
  constexpr std::string_view kTransport = "/compressed";
  std::string name = topic.name;
  if (name.ends_with(kTransport)) name.resize(name.size() - kTransport.size());
  return name;
}

std::string camera_of(const Topic& topic) { return parent_of(without_transport(topic)); }

/// Every "left" replaced by "right"; nothing if there is none.
std::optional<std::string> other_side(const std::string& name, const Sides& sides) {
  std::string other;
  std::size_t from = 0, found = 0;
  while ((found = name.find(sides.left, from)) != std::string::npos) {
    other.append(name, from, found - from).append(sides.right);
    from = found + sides.left.size();
  }
  if (from == 0) return std::nullopt;
  return other.append(name, from);
}

/// Smaller is better.
int rank(const Topic& topic) {
  const std::string name = without_transport(topic);
  const bool is_raw = name.ends_with("/image_raw") && !is_rectified(topic.name);
  const int by_name = is_raw ? 0 : is_rectified(topic.name) ? 2 : 1;
  return 2 * by_name + (topic.kind.meaning == Meaning::compressed_image ? 1 : 0);
}

std::vector<TopicPair> pairs_by_name(const std::vector<Topic>& topics) {
  std::vector<TopicPair> pairs;
  for (const Topic& left : topics) {
    // Depth as a picture (compressedDepth, too) is no camera's view.
    if (!is_picture(left) || left.name.find("epth") != std::string::npos) continue;
    for (const Sides& sides : kSides) {
      const auto right_name = other_side(left.name, sides);
      if (!right_name) continue;
      const auto right = std::find_if(topics.begin(), topics.end(), [&](const Topic& topic) {
        return is_picture(topic) && topic.name == *right_name;
      });
      if (right == topics.end()) continue;
      pairs.push_back({left, *right});
      break;
    }
  }
  return pairs;
}

[[noreturn]] void refuse(const std::vector<Topic>& topics, const std::string& file, const std::string& why) {
  std::string list;
  for (const Topic& topic : topics) {
    if (is_picture(topic)) list += (list.empty() ? "" : ", ") + topic.name + " (" + topic.schema + ")";
  }
  if (list.empty()) {
    throw std::runtime_error(file +
                             ": holds no pictures; allowed: sensor_msgs Image and CompressedImage as cdr or "
                             "ros1, foxglove RawImage and CompressedImage as protobuf");
  }
  throw std::runtime_error(file + ": " + why + "; topics of pictures: " + list +
                           "; name two: mcap:FILE,LEFT_TOPIC,RIGHT_TOPIC");
}

}  // namespace

bool is_rectified(const std::string& image_topic) {
  constexpr std::string_view kWord = "rect";  // image_rect, image_rect_raw, rectified; but not direct
  for (std::size_t at = image_topic.find(kWord); at != std::string::npos;
       at = image_topic.find(kWord, at + 1))
    if (at > 0 && (image_topic[at - 1] == '/' || image_topic[at - 1] == '_')) return true;
  return false;
}

TopicPair choose_topics(const std::vector<Topic>& topics, const std::string& file) {
  std::vector<TopicPair> pairs = pairs_by_name(topics);
  if (pairs.empty()) refuse(topics, file, "no two topics of pictures are called left and right");
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const TopicPair& a, const TopicPair& b) { return rank(a.left) < rank(b.left); });
  const TopicPair& best = pairs.front();
  for (const TopicPair& other : pairs) {
    const bool same_camera = camera_of(other.left) == camera_of(best.left);
    const bool as_good = &other != &best && rank(other.left) == rank(best.left);
    if (!same_camera || as_good) {
      refuse(topics, file,
             "both " + best.left.name + " and " + other.left.name + " could be the left camera");
    }
  }
  return best;
}

TopicPair named_topics(const std::vector<Topic>& topics, const std::string& left, const std::string& right,
                       const std::string& file) {
  const auto find = [&](const std::string& name) -> const Topic& {
    const auto found = std::find_if(topics.begin(), topics.end(), [&](const Topic& topic) {
      return is_picture(topic) && topic.name == name;
    });
    if (found == topics.end()) refuse(topics, file, "holds no pictures as '" + name + "'");
    return *found;
  };
  TopicPair pair{find(left), find(right)};
  if (left == right) refuse(topics, file, "left and right must be two topics, got '" + left + "' twice");
  return pair;
}

std::optional<TopicPair> info_topics(const std::vector<Topic>& topics, const TopicPair& images) {
  const auto beside = [&](const Topic& image) -> std::optional<Topic> {
    std::vector<Topic> found;
    for (const Topic& topic : topics) {
      if (!is_picture(topic) && parent_of(topic.name) == camera_of(image)) found.push_back(topic);
    }
    const auto plain = std::find_if(found.begin(), found.end(),
                                    [](const Topic& topic) { return topic.name.ends_with("/camera_info"); });
    if (plain != found.end()) return *plain;
    return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
  };
  auto left = beside(images.left), right = beside(images.right);
  if (!left || !right || left->name == right->name) return std::nullopt;
  return TopicPair{std::move(*left), std::move(*right)};
}

}  // namespace flogmap::mcap
