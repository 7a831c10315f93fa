#include "camera/board_calibration/markers.hpp"

#include <map>
#include <opencv2/core.hpp>
#include <stdexcept>

#if defined(FLOGMAP_MARKERS)
#include <opencv2/core/version.hpp>
#define FLOGMAP_ARUCO_IN_OBJDETECT (CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 7))
#if FLOGMAP_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif
#endif

namespace flogmap {

const std::vector<std::string>& aruco_dictionaries() {
  static const std::vector<std::string> names{"4X4_50",  "4X4_100", "4X4_250",  "5X5_50",
                                              "5X5_100", "5X5_250", "5X5_1000", "6X6_50",
                                              "6X6_100", "6X6_250", "6X6_1000"};
  return names;
}

#if defined(FLOGMAP_MARKERS)
namespace {

int dictionary_number(const std::string& name) {
  using namespace cv::aruco;
  static const std::map<std::string, int> numbers{
      {"4X4_50", DICT_4X4_50},     {"4X4_100", DICT_4X4_100},   {"4X4_250", DICT_4X4_250},
      {"5X5_50", DICT_5X5_50},     {"5X5_100", DICT_5X5_100},   {"5X5_250", DICT_5X5_250},
      {"5X5_1000", DICT_5X5_1000}, {"6X6_50", DICT_6X6_50},     {"6X6_100", DICT_6X6_100},
      {"6X6_250", DICT_6X6_250},   {"6X6_1000", DICT_6X6_1000}, {"APRILTAG_36h11", DICT_APRILTAG_36h11}};
  const auto found = numbers.find(name);
  if (found == numbers.end()) {
    std::string allowed;
    for (const std::string& known : aruco_dictionaries()) allowed += (allowed.empty() ? "" : ", ") + known;
    throw std::runtime_error("dictionary '" + name + "' must be one of " + allowed);
  }
  return found->second;
}

using Corners = std::vector<std::vector<cv::Point2f>>;

void detect(const cv::Mat& picture, const std::string& dictionary, int border_bits, Corners& corners,
            std::vector<int>& ids) {
#if FLOGMAP_ARUCO_IN_OBJDETECT
  cv::aruco::DetectorParameters parameters;
  parameters.markerBorderBits = border_bits;
  const cv::aruco::ArucoDetector detector(cv::aruco::getPredefinedDictionary(dictionary_number(dictionary)),
                                          parameters);
  detector.detectMarkers(picture, corners, ids);
#else
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->markerBorderBits = border_bits;
  cv::aruco::detectMarkers(picture, cv::aruco::getPredefinedDictionary(dictionary_number(dictionary)),
                           corners, ids, parameters);
#endif
}

}  // namespace

bool markers_are_supported() { return true; }

std::vector<Marker> find_markers(const Image<std::uint8_t>& picture, const std::string& dictionary,
                                 int border_bits) {
  // OpenCV has no read-only view; the matrix is only read.
  const cv::Mat view(picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.pixels.data()));
  Corners corners;
  std::vector<int> ids;
  detect(view, dictionary, border_bits, corners, ids);
  std::vector<Marker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Marker marker{ids[i], {}};
    for (std::size_t k = 0; k < 4; ++k) marker.corners_px[k] = {corners[i][k].x, corners[i][k].y};
    markers.push_back(marker);
  }
  return markers;
}

Image<std::uint8_t> draw_marker(const std::string& dictionary, int id, int border_bits, int side_px) {
  Image<std::uint8_t> picture(side_px, side_px);
  cv::Mat view(side_px, side_px, CV_8U, picture.pixels.data());
#if FLOGMAP_ARUCO_IN_OBJDETECT
  cv::aruco::generateImageMarker(cv::aruco::getPredefinedDictionary(dictionary_number(dictionary)), id,
                                 side_px, view, border_bits);
#else
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(dictionary_number(dictionary)), id, side_px, view,
                        border_bits);
#endif
  return picture;
}

#else  // no aruco module

namespace {
[[noreturn]] void refuse() {
  throw std::runtime_error(
      "this build cannot find markers (OpenCV's aruco module was missing when it was built); a chessboard "
      "works");
}
}  // namespace

bool markers_are_supported() { return false; }
std::vector<Marker> find_markers(const Image<std::uint8_t>&, const std::string&, int) { refuse(); }
Image<std::uint8_t> draw_marker(const std::string&, int, int, int) { refuse(); }

#endif

}  // namespace flogmap
