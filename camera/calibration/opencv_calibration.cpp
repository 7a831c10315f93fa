#include "camera/calibration/opencv_calibration.hpp"

#include <initializer_list>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {
namespace {

constexpr std::initializer_list<const char*> kLeftMatrix{"M1", "K1", "cameraMatrix1", "camera_matrix_1",
                                                         "left_camera_matrix"};
constexpr std::initializer_list<const char*> kRightMatrix{"M2", "K2", "cameraMatrix2", "camera_matrix_2",
                                                          "right_camera_matrix"};
constexpr std::initializer_list<const char*> kLeftDistortion{"D1", "distCoeffs1", "dist_coeffs_1",
                                                             "left_distortion"};
constexpr std::initializer_list<const char*> kRightDistortion{"D2", "distCoeffs2", "dist_coeffs_2",
                                                              "right_distortion"};

/// "<a><rows>3</rows>...<data>1 2 3</data></a>" → {a: [1, 2, 3]}; "<b>7</b>" → {b: [7]}; other elements are
/// kept as text.
YAML::Node from_xml(const std::string& xml, const std::string& origin) {
  YAML::Node root(YAML::NodeType::Map);
  std::size_t at = xml.find("<opencv_storage>");
  if (at == std::string::npos) throw std::runtime_error(origin + ": no <opencv_storage> element");
  at += std::string("<opencv_storage>").size();
  while ((at = xml.find('<', at)) != std::string::npos && xml[at + 1] != '/') {
    const std::size_t open_end = xml.find('>', at);
    const std::string tag = xml.substr(at + 1, open_end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (tag.starts_with("!--") || tag.ends_with('/')) {
      at = open_end;
      continue;
    }
    const std::size_t close =
        open_end == std::string::npos ? open_end : xml.find("</" + name + ">", open_end);
    if (close == std::string::npos)
      throw std::runtime_error(origin + ": element <" + name + "> is not closed");
    std::string content = xml.substr(open_end + 1, close - open_end - 1);
    if (const std::size_t data = content.find("<data>"); data != std::string::npos) {
      content = content.substr(data + 6, content.find("</data>") - data - 6);
    }
    std::istringstream words(content);
    YAML::Node list(YAML::NodeType::Sequence);
    for (std::string word; words >> word;) list.push_back(word);
    if (list.size() == 1) {
      root[name] = list[0];
    } else {
      root[name] = list;
    }
    at = close + name.size() + 3;
  }
  return root;
}

YAML::Node load(const std::string& text, const std::string& origin) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const bool xml = first != std::string::npos && text[first] == '<';
  return xml ? from_xml(text, origin) : yaml::parse(text, origin);
}

/// The name under which a file has a field; the first of the list if it has none, so that messages name that.
std::string name_in(const YAML::Node& root, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (root[name]) return name;
  }
  return *names.begin();
}

std::vector<double> picture_size(const YAML::Node& root, const std::string& origin) {
  for (const char* name : {"size", "image_size", "imageSize", "image_Size"}) {
    if (root[name]) return yaml::numbers(root, {origin, name}, 2);
  }
  for (const auto& [width, height] :
       {std::pair("image_width", "image_height"), std::pair("width", "height")}) {
    if (root[width]) return {yaml::number(root, {origin, width}), yaml::number(root, {origin, height})};
  }
  return {};
}

/// OpenCV writes 4, 5, 8, 12 or 14 coefficients; the upper ones are mostly zeros.
std::vector<double> without_needless_zeros(std::vector<double> coefficients) {
  const auto cut_to = [&](std::size_t count) {
    while (coefficients.size() > count && coefficients.back() == 0) coefficients.pop_back();
  };
  if (coefficients.size() > 8) cut_to(8);
  if (coefficients.size() > 5 && coefficients.size() <= 8) {
    const std::size_t before = coefficients.size();
    cut_to(5);
    if (coefficients.size() > 5) coefficients.resize(before, 0.0);
  }
  return coefficients;
}

CameraIntrinsics camera_of(const YAML::Node& root, const std::string& origin, const std::string& matrix,
                           const std::string& distortion) {
  CameraIntrinsics camera;
  const std::vector<double> K = yaml::numbers(root, {origin, matrix}, 9);
  set_pinhole(camera, K[0], K[4], K[2], K[5], origin + ": " + matrix);
  if (const std::vector<double> size = picture_size(root, origin); !size.empty()) {
    set_resolution(camera, size, origin + ": picture size");
  }
  const bool fisheye = root["distortion_model"] && root["distortion_model"].IsScalar() &&
                       root["distortion_model"].Scalar() != "radtan" &&
                       root["distortion_model"].Scalar() != "rational";
  std::vector<double> coefficients = without_needless_zeros(yaml::numbers(root, {origin, distortion}));
  const std::string model = fisheye                   ? root["distortion_model"].Scalar()
                            : coefficients.size() > 5 ? "rational"
                                                      : "radtan";
  set_distortion(camera, model, std::move(coefficients), origin + ": " + distortion);
  return camera;
}

void write_matrix(std::ostream& out, const char* name, int rows, const std::vector<double>& values) {
  out << name << ": !!opencv-matrix\n   rows: " << rows << "\n   cols: " << values.size() / rows
      << "\n   dt: d\n   data: [ ";
  for (std::size_t i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
  out << " ]\n";
}

const char* model_name(Distortion distortion) {
  switch (distortion) {
    case Distortion::equidistant:
      return "fisheye";
    case Distortion::rational:
      return "rational";
    case Distortion::none:
    case Distortion::radtan:
      break;
  }
  return "radtan";
}

void write_camera(std::ostream& out, const CameraIntrinsics& camera, const char* matrix,
                  const char* distortion) {
  write_matrix(out, matrix, 3, {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1});
  write_matrix(out, distortion, 1,
               camera.coefficients.empty() ? std::vector<double>(4, 0.0) : camera.coefficients);
}

}  // namespace

StereoCalibration parse_opencv(const std::string& text, const std::string& origin) {
  const YAML::Node root = load(text, origin);
  StereoCalibration calibration;
  calibration.left = camera_of(root, origin, name_in(root, kLeftMatrix), name_in(root, kLeftDistortion));
  calibration.right = camera_of(root, origin, name_in(root, kRightMatrix), name_in(root, kRightDistortion));
  calibration.right_from_left.linear() = checked_rotation(yaml::numbers(root, {origin, "R"}), origin + ": R");
  const std::vector<double> T = yaml::numbers(root, {origin, "T"}, 3);
  calibration.right_from_left.translation() << T[0], T[1], T[2];
  calibration.dialect = "opencv";
  calibration.origin = origin;
  return calibration;
}

bool is_opencv_calibration(const std::string& text, const std::string& origin) {
  const YAML::Node root = load(text, origin);
  return root[name_in(root, kLeftMatrix)] || root[name_in(root, kRightMatrix)];
}

std::string format_opencv(const StereoCalibration& calibration) {
  std::ostringstream out;
  out << std::setprecision(17) << "%YAML:1.0\n---\n"
      << "image_width: " << calibration.left.width_px << "\nimage_height: " << calibration.left.height_px
      << "\ndistortion_model: " << model_name(calibration.left.distortion) << "\n";
  write_camera(out, calibration.left, "M1", "D1");
  write_camera(out, calibration.right, "M2", "D2");
  const Eigen::Matrix3d R =
      calibration.right_from_left.linear().transpose();  // column-major storage: row-major list
  write_matrix(out, "R", 3, std::vector<double>(R.data(), R.data() + 9));
  const Eigen::Vector3d T = calibration.right_from_left.translation();
  write_matrix(out, "T", 3, {T.x(), T.y(), T.z()});
  return out.str();
}

}  // namespace flogmap
