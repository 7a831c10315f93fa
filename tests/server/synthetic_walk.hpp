#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "server/publication.hpp"

namespace flogmap {

/// A camera that walks an ellipse in a made-up house of 12 x 8 m: a map that grows behind it, poses, pictures
/// and reports, without any vision. Everything follows from the step number and the seed.
class SyntheticWalk {
 public:
  static constexpr int kStepsPerRound = 1200;  // 60 s at 20 steps a second

  explicit SyntheticWalk(std::uint32_t seed = 1);

  [[nodiscard]] MapBegin begin(const std::string& epoch, const std::string& reason) const;

  /// Moves on, sees, and returns the tiles that changed (none between mapped views).
  std::vector<TileUpdate> step();

  [[nodiscard]] TrackingReport tracking();
  [[nodiscard]] PictureReport pictures() const;
  [[nodiscard]] StatusReport status() const;
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] std::uint64_t num_steps() const { return num_steps_; }

 private:
  struct Place {
    double x_m = 0, y_m = 0, heading_rad = 0;
  };
  [[nodiscard]] Place place() const;
  void see(const Place& from, double direction_rad, int layer);
  void add(double x_m, double y_m, int layer, float mu_E, float mu_O);

  MapInfo info_;
  StereoCamera camera_;
  std::mt19937 random_;
  std::map<TileIndex, Tile> tiles_;
  std::map<TileIndex, bool> touched_;
  std::uint64_t revision_ = 0;
  std::uint64_t num_steps_ = 0;
};

}  // namespace flogmap
