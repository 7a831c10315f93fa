#include "camera/simulation/scene_json.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/two_boxes_scenes.hpp"

namespace flogmap::experiments {

Workshop::Workshop(std::filesystem::path out, std::optional<std::filesystem::path> recordings)
    : out_(std::move(out)), recordings_(std::move(recordings)) {
  std::filesystem::create_directories(out_);
}

const Passage* Workshop::passage(const std::string& name) {
  if (const auto known = passages_.find(name); known != passages_.end()) return &known->second;
  const bool boxes = name.find("two-boxes") != std::string::npos;
  PassageOptions options = boxes ? two_boxes_passage_options() : PassageOptions{};
  options.keep_exact = !boxes;
  const std::string recorded = "recorded ";
  if (!name.starts_with(recorded)) {
    return &passages_.emplace(name, pass_scene(load_scene(name), options)).first->second;
  }
  if (!recordings_) return nullptr;
  const auto folder = *recordings_ / name.substr(recorded.size());
  if (!std::filesystem::exists(folder)) return nullptr;
  return &passages_.emplace(name, pass_recording(folder, options)).first->second;
}

}  // namespace flogmap::experiments
