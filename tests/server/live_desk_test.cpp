// Live calibration from end to end without cameras: a rendered board is shown to the desk, as a source
// delivers it.
#include "server/commands/live_desk.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "camera/calibration/detect.hpp"
#include "tests/camera/rendered_board.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

const BoardSpec kBoard{.square_m = 0.06};

Picture picture_of(const Image<std::uint8_t>& grey) {
  Picture picture{grey.width, grey.height, 1, 8, {}};
  picture.bytes.assign(grey.pixels.begin(), grey.pixels.end());
  return picture;
}

/// Photos of a board by two cameras 6 cm apart; each comes when the one before has been looked at.
class BoardPhotos final : public StereoSource {
 public:
  explicit BoardPhotos(int count) {
    CameraIntrinsics camera{320, 240, 260, 260, 159.5, 119.5, Distortion::radtan, {0, 0, 0, 0}};
    const testing::BoardCamera eye(camera);
    const auto paint = testing::paint_chessboard(kBoard);
    std::mt19937 random(7);
    for (const Eigen::Isometry3d& pose : testing::board_poses(kBoard, count, 1.3, 0.4, false)) {
      const Eigen::Isometry3d right = Eigen::Translation3d(-0.06, 0, 0) * pose;
      frames_.push_back({std::ssize(frames_) * 100'000'000, picture_of(eye.picture(paint, pose, random)),
                         picture_of(eye.picture(paint, right, random))});
    }
    frames_.push_back(frames_.front());  // nothing new: seen, but not kept
    frames_.back().timestamp_ns = std::ssize(frames_) * 100'000'000;
  }
  std::optional<StereoFrame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }
  void stop() override { next_ = frames_.size(); }
  [[nodiscard]] SourceInfo info() const override {
    return {.spec = "photos", .num_frames = std::ssize(frames_)};
  }
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override { return std::nullopt; }

 private:
  std::vector<StereoFrame> frames_;
  std::size_t next_ = 0;
};

class Desk : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  std::string out_ = (folder_.path() / "calib.yaml").string();

  json wait_for(const LiveDesk& desk, const std::function<bool(const json&)>& met) {
    for (int i = 0; i < 6000; ++i) {
      json state = json::parse(desk.state_json());
      if (met(state)) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "waited in vain: " << desk.state_json();
    return json::parse(desk.state_json());
  }
};

TEST_F(Desk, WithoutViewersItCalibratesAtTheEndAndWritesTheFile) {
  BoardPhotos photos(14);
  LiveDesk desk({.board = kBoard, .photos = true, .out = out_});
  desk.run(photos, false);
  ASSERT_TRUE(desk.verdict()) << desk.problem();
  EXPECT_NEAR(desk.verdict()->baseline_m, 0.06, 0.001);
  EXPECT_NEAR(read_calibration(out_).left.fx_px, 260, 4);
}

TEST_F(Desk, ViewersSeeCornersAndCoverageAndGetTheirVerdictWhenTheyAskForIt) {
  BoardPhotos photos(14);
  LiveDesk desk({.board = kBoard, .photos = true, .out = out_});
  EXPECT_FALSE(desk.solve());  // nothing has been kept
  EXPECT_EQ(desk.pictures(), nullptr);
  std::jthread looker([&] { desk.run(photos, true); });
  const json seen = wait_for(desk, [](const json& state) { return state["phase"] == "ended"; });
  EXPECT_GE(seen["pairs"], 10);
  EXPECT_EQ(seen["left"]["corners"].size(), 54U);
  EXPECT_EQ(seen["left"]["areas"].size(), 9U);
  EXPECT_EQ(seen["kept"], false);
  EXPECT_EQ(seen["verdict"], nullptr);
  EXPECT_EQ(desk.pictures()->left.width, 320);
  EXPECT_TRUE(desk.solve());
  const json solved = wait_for(desk, [](const json& state) { return state["verdict"].is_object(); });
  EXPECT_NEAR(solved["verdict"]["baseline_m"], 0.06, 0.001);
  EXPECT_TRUE(std::filesystem::exists(out_));
  desk.restart();
  const json anew = wait_for(desk, [](const json& state) { return state["pairs"] == 0; });
  EXPECT_EQ(anew["verdict"], nullptr);
  desk.stop();
}

TEST_F(Desk, TooFewPairsAndAFullDiskAreSaidInWords) {
  BoardPhotos few(1);  // and the same again
  LiveDesk desk({.board = kBoard, .photos = true, .out = out_});
  desk.run(few, false);
  EXPECT_FALSE(desk.verdict());
  EXPECT_THAT(desk.problem(), ::testing::HasSubstr("pairs show the board"));
  BoardPhotos photos(10);
  LiveDesk nowhere({.board = kBoard, .photos = true, .out = "/nowhere/calib.yaml"});
  nowhere.run(photos, false);
  EXPECT_FALSE(nowhere.verdict());
  EXPECT_THAT(nowhere.problem(), ::testing::HasSubstr("/nowhere/calib.yaml"));
}

}  // namespace
}  // namespace flogmap
