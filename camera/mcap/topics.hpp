// Which of a recording's topics are the two cameras. Pure: names in, names out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/mcap/message_kind.hpp"

namespace flogmap::mcap {

/// A topic that can be read.
struct Topic {
  std::string name;
  std::string schema;
  MessageKind kind;
};

struct TopicPair {
  Topic left, right;
};

/// Two topics of pictures that are called alike but for left and right, cam0 and cam1, or infra1 and infra2.
/// Of those of one camera, image_raw comes before others and they before rectified ones, raw pictures before
/// compressed ones. Throws std::runtime_error in one line that names the topics there are, and how to name
/// two of them, where that leaves none or several.
[[nodiscard]] TopicPair choose_topics(const std::vector<Topic>& topics, const std::string& file);

/// These two. Throws likewise where one of them is not among the topics of pictures.
[[nodiscard]] TopicPair named_topics(const std::vector<Topic>& topics, const std::string& left,
                                     const std::string& right, const std::string& file);

/// True if the pictures of this topic are rectified already, by its name.
[[nodiscard]] bool is_rectified(const std::string& image_topic);

/// The camera_info topics that lie beside both; nothing where one has none, or both the same.
[[nodiscard]] std::optional<TopicPair> info_topics(const std::vector<Topic>& topics, const TopicPair& images);

}  // namespace flogmap::mcap
