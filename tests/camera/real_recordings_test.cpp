// The recordings of FLOGMAP_DATA, where that is set: rows are epipolar, poses and gravity agree.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/features2d.hpp>

#include "camera/rectifier.hpp"
#include "camera/source_spec.hpp"

namespace flogmap {
namespace {

class RealRecordings : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("FLOGMAP_DATA");
    if (folder == nullptr) GTEST_SKIP() << "FLOGMAP_DATA is not set";
    folder_ = folder;
  }

  /// The 95th percentile of the vertical distance between matching ORB corners of a rectified pair.
  static double vertical_error_px(const RectifiedFrame& frame) {
    const auto view = [](const Image<std::uint8_t>& image) {
      return cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
    };
    const cv::Ptr<cv::ORB> orb = cv::ORB::create(1500, 1.2F, 1);
    std::vector<cv::KeyPoint> left, right;
    cv::Mat left_descriptors, right_descriptors;
    orb->detectAndCompute(view(frame.left), {}, left, left_descriptors);
    orb->detectAndCompute(view(frame.right), {}, right, right_descriptors);
    std::vector<std::vector<cv::DMatch>> matches;
    cv::BFMatcher(cv::NORM_HAMMING).knnMatch(left_descriptors, right_descriptors, matches, 2);
    std::vector<double> errors;
    for (const auto& best : matches) {
      if (best.size() < 2 || best[0].distance > 0.7F * best[1].distance) continue;  // could be another corner
      const cv::Point2f d = left[best[0].queryIdx].pt - right[best[0].trainIdx].pt;
      if (d.x >= 0 && d.x < 120 && std::abs(d.y) < 5) errors.push_back(std::abs(d.y));  // else a mismatch
    }
    EXPECT_GT(errors.size(), 100U);
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() * 95 / 100];
  }

  void expect_epipolar(const std::string& spec, double p95_px) {
    const auto source = open_source({.spec = spec});
    const Rectifier rectifier(*source->calibration());
    for (int i = 0; i < 3; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame);
      EXPECT_LE(vertical_error_px(rectifier.rectify(*frame)), p95_px) << spec;
    }
    EXPECT_EQ(source->skipped().count, 0);
  }

  std::string folder_;
};

TEST_F(RealRecordings, RowsAreEpipolar) {
  // ORB's corners lie on whole pixels: one pixel is as good as it can say.
  expect_epipolar("euroc:" + folder_ + "/euroc_mh01_10hz", 1.0);
  expect_epipolar("euroc:" + folder_ + "/euroc_v101_views", 1.0);
  expect_epipolar("euroc:" + folder_ + "/house-dev", 1.0);
  expect_epipolar("kitti:" + folder_ + "/kitti03", 1.0);
}

TEST_F(RealRecordings, HaveTheCamerasTheyAreKnownToHave) {
  const auto camera = [&](const std::string& spec) {
    return Rectifier(*open_source({.spec = spec})->calibration()).camera();
  };
  EXPECT_NEAR(camera("euroc:" + folder_ + "/euroc_mh01_10hz").baseline_m, 0.11, 5e-4);
  EXPECT_EQ(camera("euroc:" + folder_ + "/house-dev"), (StereoCamera{417, 319.5, 239.5, 0.12, 640, 480}));
  EXPECT_EQ(camera("euroc:" + folder_ + "/two-boxes-near"),
            (StereoCamera{416.8, 159.5, 119.5, 0.1, 320, 240}));
  const StereoCamera kitti = camera("kitti:" + folder_ + "/kitti03");
  EXPECT_NEAR(kitti.focal_px, 721.5377, 1e-9);
  EXPECT_NEAR(kitti.baseline_m, 0.53715, 1e-5);
  EXPECT_EQ(kitti.width_px, 1242);
}

TEST_F(RealRecordings, TheInertialSensorKnowsUp) {
  const auto source = open_source({.spec = "euroc:" + folder_ + "/euroc_v101_still"});
  const auto up = source->up_in_left_camera();
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->norm(), 1, 1e-9);
  EXPECT_LT(up->y(), -0.9);  // the camera stands upright: up is -y
  EXPECT_FALSE(open_source({.spec = "euroc:" + folder_ + "/euroc_mh01_10hz"})->up_in_left_camera());
}

TEST_F(RealRecordings, AreReadToTheirEnds) {
  const auto count = [&](const std::string& spec) {
    const auto source = open_source({.spec = spec});
    int frames = 0;
    while (source->next()) ++frames;
    EXPECT_EQ(source->info().num_frames, frames);
    return frames;
  };
  EXPECT_EQ(count("euroc:" + folder_ + "/euroc_mh01_10hz"), 110);
  EXPECT_EQ(count("euroc:" + folder_ + "/euroc_v101_still"), 30);
  EXPECT_EQ(count("euroc:" + folder_ + "/euroc_v101_views"), 50);
  EXPECT_EQ(count("euroc:" + folder_ + "/two-boxes-far"), 33);
  EXPECT_EQ(count("kitti:" + folder_ + "/kitti03"), 70);
}

}  // namespace
}  // namespace flogmap
