// The experiments, one file each. docs/experiments/ holds what they say.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "tests/experiments/passage.hpp"
#include "tests/experiments/report.hpp"

namespace flogmap::experiments {

/// Where experiments take recordings from and leave pictures; keeps the passages that several of them use.
class Workshop {
 public:
  /// `recordings`: a folder with two-boxes-near, two-boxes-far and house-dev, made by another renderer.
  Workshop(std::filesystem::path out, std::optional<std::filesystem::path> recordings);

  /// A file beside the report.
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return out_ / name; }

  /// A scene with this program, or "recorded NAME" from the other renderer; nothing where that is missing.
  const Passage* passage(const std::string& name);

  /// Forgets a large passage that nobody needs any more.
  void drop(const std::string& name) { passages_.erase(name); }

 private:
  std::filesystem::path out_;
  std::optional<std::filesystem::path> recordings_;
  std::map<std::string, Passage> passages_;
};

Report two_boxes(Workshop& workshop);
Report side_widths(Workshop& workshop);
Report hidden_sides(Workshop& workshop);
Report layer_heights(Workshop& workshop);
Report hand_held(Workshop& workshop);
Report segment_filter(Workshop& workshop);
Report row_steps(Workshop& workshop);
Report table_layers(Workshop& workshop);
Report removed_box(Workshop& workshop);
Report repeated_views(Workshop& workshop);
Report bayesian_grid(Workshop& workshop);
Report paper_mode(Workshop& workshop);
Report speed(Workshop& workshop);

/// Share of flat walls `near_m` ahead, seen exactly at 60 places within one cell of 20 mm, that are in the
/// map.
[[nodiscard]] double walls_found(const StereoCamera& camera, double near_m, bool paper_mode);

}  // namespace flogmap::experiments
