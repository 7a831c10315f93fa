// A calibration that suits its pictures passes; the usual mix-ups are told apart and named.
#include <gmock/gmock.h>

#include <cstdlib>

#include "camera/calibration/calibration_review.hpp"
#include "camera/calibration/detect.hpp"
#include "camera/simulated_source.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/small_scene.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

struct Taken {
  StereoCalibration calibration;
  std::vector<StereoFrame> frames;
};

const Taken& simulated() {
  static const Taken taken = [] {
    SimulatedSource source("sim:small", testing::small_scene(), 1);
    Taken result{*source.calibration(), {}};
    for (int i = 0; i < 3; ++i) result.frames.push_back(*source.next());
    return result;
  }();
  return taken;
}

std::vector<StereoFrame> exchanged(std::vector<StereoFrame> frames) {
  for (StereoFrame& frame : frames) std::swap(frame.left, frame.right);
  return frames;
}

TEST(CalibrationReview, TheRightCalibrationHasNoFault) {
  const CalibrationReview review = review_calibration(simulated().calibration, simulated().frames);
  EXPECT_THAT(review.faults, IsEmpty());
  EXPECT_GT(review.num_matches, 200U);
  EXPECT_LT(review.vertical_p50_px, 0.5);
}

TEST(CalibrationReview, ExchangedPicturesAreNamed) {
  EXPECT_THAT(review_calibration(simulated().calibration, exchanged(simulated().frames)).faults,
              Contains(HasSubstr("pictures are exchanged")));
}

TEST(CalibrationReview, ATransformTheWrongWayIsNamed) {
  StereoCalibration wrong = simulated().calibration;
  wrong.right_from_left = wrong.right_from_left.inverse();
  // With equal cameras, exchanging them says the same.
  EXPECT_THAT(review_calibration(wrong, simulated().frames).faults,
              Contains(::testing::AnyOf(HasSubstr("exchange its two cameras"), HasSubstr("invert"))));
}

TEST(CalibrationReview, AShiftedPictureIsMeasured) {
  StereoCalibration shifted = simulated().calibration;
  shifted.right.cy_px += 1.8;
  shifted.rectified = false;
  const CalibrationReview review = review_calibration(shifted, simulated().frames);
  EXPECT_NEAR(review.vertical_bias_px, -1.8, 0.4);
  EXPECT_THAT(review.faults, Contains(HasSubstr("calibrate again")));
}

TEST(CalibrationReview, PicturesWithoutTextureAreNoVerdict) {
  const Picture grey{320, 240, 1, 8, std::vector<std::uint8_t>(320 * 240, 128)};
  EXPECT_THAT(review_calibration(simulated().calibration, {{0, grey, grey}}).faults,
              Contains(HasSubstr("texture")));
}

TEST(CalibrationReview, MillimetresAreRecognised) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("calib.yaml",
                                 "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
                                 "M1: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nD1: [0, 0, 0, 0]\n"
                                 "M2: [500, 0, 320, 0, 500, 240, 0, 0, 1]\nD2: [0, 0, 0, 0]\n"
                                 "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-120, 0, 0]\n");
  EXPECT_THAT([&] { (void)read_calibration(file); },
              ThrowsMessage<std::runtime_error>(HasSubstr("millimetres")));
}

/// Real cameras, which are not equal, tell exchanged cameras from exchanged pictures.
TEST(CalibrationReview, RealRecordingsPassAndTheirMixUpsAreTold) {
  const char* data = std::getenv("FLOGMAP_DATA");
  if (data == nullptr) GTEST_SKIP() << "FLOGMAP_DATA is not set";
  const auto source = open_source({.spec = "euroc:" + std::string(data) + "/euroc_mh01_10hz"});
  std::vector<StereoFrame> frames;
  for (int i = 0; i < 3; ++i) frames.push_back(*source->next());
  const StereoCalibration right = *source->calibration();
  EXPECT_THAT(review_calibration(right, frames).faults, IsEmpty());
  EXPECT_THAT(review_calibration(right, exchanged(frames)).faults,
              Contains(HasSubstr("pictures are exchanged")));
  StereoCalibration swapped = right;
  std::swap(swapped.left, swapped.right);
  swapped.right_from_left = swapped.right_from_left.inverse();
  EXPECT_THAT(review_calibration(swapped, frames).faults, Contains(HasSubstr("exchange its two cameras")));
}

}  // namespace
}  // namespace flogmap
