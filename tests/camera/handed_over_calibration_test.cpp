// A calibration from somewhere else, in any of the five dialects: right, with left and right exchanged, in
// millimetres, or for another resolution. Each is recognised and said.
#include <gmock/gmock.h>

#include "camera/calibration/calibration_review.hpp"
#include "camera/picture_files.hpp"
#include "camera/simulated_source.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/small_scene.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// What somebody hands over: the simulated pair, with a mistake or without.
struct Handed {
  double scale = 1;        // of the resolution
  double per_metre = 1;    // 1000: millimetres
  bool exchanged = false;  // the left camera is called right
};

struct Text {
  std::string left, right;  // right stays empty where one file holds both
};

constexpr double kFocalPx = 210, kCxPx = 159.5, kCyPx = 119.5, kBaselineM = 0.12;
constexpr int kWidthPx = 320, kHeightPx = 240;

std::string number(double value) { return std::to_string(value); }
std::string bracketed(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text.append(text.empty() ? "[" : ", ").append(number(value));
  return text.append("]");
}
std::string matrix3(const Handed& h) {
  const double f = h.scale * kFocalPx;
  return bracketed({f, 0, h.scale * kCxPx, 0, f, h.scale * kCyPx, 0, 0, 1});
}
std::string pinhole(const Handed& h) {
  return bracketed({h.scale * kFocalPx, h.scale * kFocalPx, h.scale * kCxPx, h.scale * kCyPx});
}
std::string size(const Handed& h) {
  return std::to_string(static_cast<int>(h.scale * kWidthPx)) + ", " +
         std::to_string(static_cast<int>(h.scale * kHeightPx));
}
/// x of the right camera in the left one.
double apart(const Handed& h) { return (h.exchanged ? -1 : 1) * h.per_metre * kBaselineM; }

Text euroc(const Handed& h) {
  const auto one = [&](double x) {
    return "T_BS:\n  data: [1, 0, 0, " + number(x) + ", 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: [" +
           size(h) + "]\ncamera_model: pinhole\nintrinsics: " + pinhole(h) +
           "\ndistortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n";
  };
  return {one(0), one(apart(h))};
}

Text kalibr(const Handed& h) {
  const std::string camera =
      "  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: radtan\n  "
      "intrinsics: " +
      pinhole(h) + "\n  resolution: [" + size(h) + "]\n";
  return {"cam0:\n" + camera + "cam1:\n  T_cn_cnm1:\n  - [1, 0, 0, " + number(-apart(h)) +
              "]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n" + camera,
          ""};
}

Text opencv(const Handed& h) {
  const std::string sizes = size(h);
  const std::size_t comma = sizes.find(',');
  return {"%YAML:1.0\n---\nimage_width: " + sizes.substr(0, comma) + "\nimage_height:" +
              sizes.substr(comma + 1) + "\nM1: " + matrix3(h) + "\nD1: [0, 0, 0, 0]\nM2: " + matrix3(h) +
              "\nD2: [0, 0, 0, 0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [" + number(-apart(h)) + ", 0, 0]\n",
          ""};
}

/// As OpenCV's own sample writes it: without a resolution.
Text opencv_without_size(const Handed& h) {
  Text text = opencv(h);
  text.left.erase(text.left.find("image_width"), text.left.find("M1:") - text.left.find("image_width"));
  return text;
}

Text ros(const Handed& h) {
  const auto one = [&](const std::string& name, double x) {
    const std::string sizes = size(h), f = number(h.scale * kFocalPx);
    const std::size_t comma = sizes.find(',');
    return "image_width: " + sizes.substr(0, comma) + "\nimage_height:" + sizes.substr(comma + 1) +
           "\ncamera_name: " + name + "\ncamera_matrix: {rows: 3, cols: 3, data: " + matrix3(h) +
           "}\ndistortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 4, data: [0, 0, 0, 0]}\n"
           "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
           "projection_matrix: {rows: 3, cols: 4, data: [" +
           f + ", 0, " + number(h.scale * kCxPx) + ", " + number(-h.scale * kFocalPx * x) + ", 0, " + f +
           ", " + number(h.scale * kCyPx) + ", 0, 0, 0, 1, 0]}\n";
  };
  const double b = h.per_metre * kBaselineM;
  if (h.exchanged) return {one("right", b), one("left", 0)};
  return {one("left", 0), one("right", b)};
}

Text kitti(const Handed& h) {
  const auto one = [&](double x) {
    const std::string f = number(h.scale * kFocalPx);
    return f + " 0 " + number(h.scale * kCxPx) + " " + number(-h.scale * kFocalPx * x) + " 0 " + f + " " +
           number(h.scale * kCyPx) + " 0 0 0 1 0\n";
  };
  const double b = h.per_metre * kBaselineM;
  return {"P0: " + one(h.exchanged ? b : 0) + "P1: " + one(h.exchanged ? 0 : b), ""};
}

struct Dialect {
  const char* name;
  Text (*write)(const Handed&);
};

/// Three pairs of the simulated room as a recording, for everybody to calibrate.
const std::string& recording() {
  static const testing::TemporaryFolder folder;
  static const std::string globs = [] {
    SimulatedSource source("sim:small", testing::small_scene(), 1);
    for (int i = 0; i < 3; ++i) {
      const auto frame = source.next();
      const std::string name = std::to_string(i) + ".png";
      (void)write_picture(folder.path() / ("left" + name), frame->left);
      (void)write_picture(folder.path() / ("right" + name), frame->right);
    }
    return "images:" + (folder.path() / "left*.png").string() + "," + (folder.path() / "right*.png").string();
  }();
  return globs;
}

class HandedOver : public ::testing::TestWithParam<Dialect> {
 protected:
  testing::TemporaryFolder folder_;

  CalibrationReview review(const Handed& handed) {
    const Text text = GetParam().write(handed);
    std::string file = folder_.write("calibration", text.left).string();
    if (!text.right.empty()) file += "," + folder_.write("right", text.right).string();
    const auto source = open_source({.spec = recording(), .calibration_file = file});
    std::vector<StereoFrame> frames;
    while (auto frame = source->next()) frames.push_back(std::move(*frame));
    return review_calibration(*source->calibration(), frames);
  }
  void expect_refused(const Handed& handed, const std::string& why) {
    EXPECT_THAT([&] { (void)review(handed); }, ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  }
};

TEST_P(HandedOver, TheRightOneFits) { EXPECT_THAT(review({}).faults, IsEmpty()); }

TEST_P(HandedOver, ExchangedCamerasAreRecognised) {
  // With equal cameras, exchanging them and inverting the transform are one.
  EXPECT_THAT(review({.exchanged = true}).faults,
              Contains(AnyOf(HasSubstr("exchange its two cameras"), HasSubstr("invert"))));
}

TEST_P(HandedOver, MillimetresAreRecognised) { expect_refused({.per_metre = 1000}, "millimetres"); }

TEST_P(HandedOver, AnotherResolutionIsRecognised) {
  for (const double scale : {0.5, 2.0, 1.5}) expect_refused({.scale = scale}, "resolution");
}

INSTANTIATE_TEST_SUITE_P(All, HandedOver,
                         ::testing::Values(Dialect{"euroc", euroc}, Dialect{"kalibr", kalibr},
                                           Dialect{"opencv", opencv},
                                           Dialect{"opencv_without_size", opencv_without_size},
                                           Dialect{"ros", ros}, Dialect{"kitti", kitti}),
                         [](const auto& dialect) { return std::string(dialect.param.name); });

/// What a recording carries is looked at as closely as what is handed over.
TEST(CarriedCalibration, InMillimetresIsRecognised) {
  const testing::TemporaryFolder folder;
  const Picture grey{kWidthPx, kHeightPx, 1, 8, std::vector<std::uint8_t>(kWidthPx * kHeightPx, 90)};
  const Text text = euroc({.per_metre = 1000});
  folder.write("mav0/cam0/sensor.yaml", text.left);
  folder.write("mav0/cam1/sensor.yaml", text.right);
  for (const char* camera : {"cam0", "cam1"}) {
    folder.write(std::string("mav0/") + camera + "/data.csv", "1000,a.png\n");
    folder.write(std::string("mav0/") + camera + "/data/a.png", "");
    ASSERT_TRUE(write_picture(folder.path() / "mav0" / camera / "data/a.png", grey));
  }
  EXPECT_THAT([&] { (void)open_source({.spec = "euroc:" + folder.path().string()}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("millimetres")));
}

}  // namespace
}  // namespace flogmap
