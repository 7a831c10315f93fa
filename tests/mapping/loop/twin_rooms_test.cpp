// Two rooms that look the same, down to the pixel, with a corridor between them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "camera/source_spec.hpp"
#include "mapping/front_end.hpp"
#include "mapping/loop/loop_closer.hpp"

namespace flogmap {
namespace {

constexpr double kApart_m = 6;  // from one room to its twin

/// A folder of its own that goes with the test.
class SceneFolder {
 public:
  SceneFolder()
      : path_(std::filesystem::temp_directory_path() / ("twin_rooms_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~SceneFolder() { std::filesystem::remove_all(path_); }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Random spots of several sizes, as a PGM.
void write_texture(const std::filesystem::path& file, unsigned seed) {
  constexpr int kSide = 256;
  std::mt19937 random(seed);
  std::string pixels(kSide * kSide, static_cast<char>(128));
  for (int spot = 0; spot < 1200; ++spot) {
    const int side = 3 + static_cast<int>(random() % 14);
    const int left = static_cast<int>(random() % (kSide - side)),
              top = static_cast<int>(random() % (kSide - side));
    const char grey = static_cast<char>(40 + random() % 176);
    for (int y = top; y < top + side; ++y) std::fill_n(pixels.begin() + y * kSide + left, side, grey);
  }
  std::ofstream(file, std::ios::binary) << "P5\n" << kSide << " " << kSide << "\n255\n" << pixels;
}

std::string number(double value) { return std::to_string(value); }

/// Three walls of a niche, wide open towards the corridor, and a cupboard in it.
std::string niche(double x) {
  const auto box = [&](double x0, double y0, double x1, double y1, double height, const char* material) {
    return R"({"box": {"min": [)" + number(x + x0) + "," + number(y0) + R"(,0], "max": [)" + number(x + x1) +
           "," + number(y1) + "," + number(height) + R"(]}, "material": ")" + material + "\"},\n";
  };
  return box(-1.5, 1.9, 1.5, 2.0, 2.6, "a") + box(-1.6, 0.5, -1.5, 2.0, 2.6, "b") +
         box(1.5, 0.5, 1.6, 2.0, 2.6, "c") + box(0.2, 1.4, 0.9, 1.9, 1.2, "d");
}

/// Looking into the niche at x from three places in front of it.
std::string look_into(double x) {
  std::string points;
  for (const double at : {-0.7, -0.2, 0.4, 0.9, 0.3, -0.4}) {
    points += R"({"at": [)" + number(x + at) + R"(,-1.0,1.3], "look_at": [)" + number(x + 0.3 * at) +
              ",1.9,1.1]},\n";
  }
  return points;
}

std::filesystem::path write_scene(const std::filesystem::path& folder) {
  std::string materials;
  for (const char* name : {"a", "b", "c", "d"}) {
    write_texture(folder / (std::string(name) + ".pgm"), static_cast<unsigned char>(*name));
    materials += std::string(",\"") + name + R"(": {"image": ")" + name + R"(.pgm", "texel_m": 0.008})";
  }
  const auto file = folder / "twin-rooms.json";
  std::ofstream(file)
      << R"({"camera": {"width_px": 320, "height_px": 240, "focal_px": 220, "baseline_m": 0.12,
 "rate_hz": 5}, "texel_m": 0.01,
 "materials": {"corridor": {"pattern": "speckle", "size_m": 0.1})"
      << materials << "},\n\"solids\": [\n"
      << niche(0) << niche(kApart_m)
      << R"({"hall": {"min": [-3,-2.2,0], "max": [9,2.1,2.7]}, "material": "corridor"}],
 "path": {"closed": false, "speed_m_s": 0.5, "points": [)"
      << look_into(0) << R"({"at": [1.6,-0.8,1.3], "look_at": [4,-0.9,1.2]},
 {"at": [3.2,-0.7,1.3], "look_at": [6,-0.6,1.2]}, {"at": [4.6,-0.8,1.3], "look_at": [6,0.8,1.1]},)"
      << look_into(kApart_m) << R"({"at": [6,-1,1.3], "look_at": [6,1.9,1.1]}]}})";
  return file;
}

/// The views that a map takes of the walk past both rooms.
std::vector<View> views_of(StereoSource& scene) {
  FrontEndOptions options;
  options.first_world_from_camera = scene.true_pose(scene.info().first_timestamp_ns);
  FrontEnd front_end(options, Rectifier(*scene.calibration()), std::nullopt, std::nullopt);
  std::vector<View> views;
  while (const auto frame = scene.next()) {
    FrontEndResult result = front_end.process(*frame);
    EXPECT_TRUE(result.tracking.has_pose());
    for (View& view : result.views) views.push_back(std::move(view));
  }
  return views;
}

/// How far the views are apart that a loop was closed between, at most.
double longest_loop_m(const std::vector<View>& views, const StereoCamera& camera,
                      const LoopOptions& options) {
  LoopCloser closer(options, camera);
  for (const View& view : views) (void)closer.add(view);
  double longest = 0;
  for (const PoseEdge& edge : closer.edges()) {
    const SE3 &from = views[edge.from].world_from_camera, &to = views[edge.to].world_from_camera;
    if (edge.may_be_wrong) longest = std::max(longest, (to.translation() - from.translation()).norm());
  }
  return longest;
}

TEST(TwinRooms, AreNotMergedThoughTheyLookTheSame) {
  const SceneFolder folder;
  const auto scene = open_source({.spec = "sim:" + write_scene(folder.path()).string(),
                                  .calibration_file = {},
                                  .loop = false,
                                  .seed = 1});
  const StereoCamera camera = Rectifier(*scene->calibration()).camera();
  const std::vector<View> views = views_of(*scene);
  ASSERT_GT(views.size(), 80U);
  EXPECT_LT(longest_loop_m(views, camera, {}), kApart_m / 2);
  LoopOptions credulous;  // who believes that odometry is off by a whole room
  credulous.drift_m = 2 * kApart_m;
  EXPECT_GT(longest_loop_m(views, camera, credulous), kApart_m / 2)
      << "the rooms are alike: only what odometry can have drifted keeps them apart";
}

}  // namespace
}  // namespace flogmap
