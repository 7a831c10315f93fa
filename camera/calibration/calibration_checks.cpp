#include "camera/calibration/calibration_checks.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "camera/calibration/distortion.hpp"

namespace flogmap {
namespace {

struct ModelName {
  const char* name;
  Distortion distortion;
};

constexpr std::array kModelNames{
    ModelName{"none", Distortion::none},
    ModelName{"radial-tangential", Distortion::radtan},
    ModelName{"radtan", Distortion::radtan},
    ModelName{"plumb_bob", Distortion::radtan},
    ModelName{"rational_polynomial", Distortion::rational},
    ModelName{"rational", Distortion::rational},
    ModelName{"equidistant", Distortion::equidistant},
    ModelName{"equi", Distortion::equidistant},
    ModelName{"fisheye", Distortion::equidistant},
};

std::string allowed_models() {
  std::string names;
  for (const ModelName& entry : kModelNames) names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

std::string list_text(const std::vector<double>& values) {
  std::ostringstream out;
  out << '[';
  for (std::size_t i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
  out << ']';
  return out.str();
}

}  // namespace

Eigen::Matrix3d checked_rotation(const std::vector<double>& row_major, const std::string& where) {
  if (row_major.size() != 9) {
    throw std::runtime_error(where + " must have 9 numbers, got " + std::to_string(row_major.size()));
  }
  const Eigen::Matrix3d given =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major.data());
  // What is exact already stays as it is, to the last bit: a recording of a recording gives the same map.
  constexpr double kExact = 4e-15;
  if ((given * given.transpose()).isIdentity(kExact) && given.determinant() > 0) return given;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  constexpr double kRounding = 0.01;
  if (!given.allFinite() || nearest.determinant() < 0 ||
      (nearest - given).cwiseAbs().maxCoeff() > kRounding) {
    throw std::runtime_error(where + " must be a rotation matrix, got " + list_text(row_major));
  }
  const bool exact = (given * given.transpose()).isIdentity(1e-12);
  return exact ? given : nearest;
}

void set_distortion(CameraIntrinsics& camera, const std::string& model, std::vector<double> coefficients,
                    const std::string& where) {
  const auto* entry = std::find_if(kModelNames.begin(), kModelNames.end(),
                                   [&](const ModelName& candidate) { return model == candidate.name; });
  if (entry == kModelNames.end()) {
    throw std::runtime_error(where + ": distortion model must be one of " + allowed_models() + ", got '" +
                             model + "'");
  }
  camera.distortion = entry->distortion;
  if (camera.distortion == Distortion::none) coefficients.clear();
  if (camera.distortion == Distortion::radtan && coefficients.empty()) camera.distortion = Distortion::none;
  if (!coefficient_count_fits(camera.distortion, coefficients.size())) {
    throw std::runtime_error(where + ": " + model + " needs " +
                             (camera.distortion == Distortion::rational ? "8" : "4") +
                             (camera.distortion == Distortion::radtan ? " or 5" : "") +
                             " coefficients, got " + list_text(coefficients));
  }
  camera.coefficients = std::move(coefficients);
}

void set_resolution(CameraIntrinsics& camera, const std::vector<double>& width_height,
                    const std::string& where) {
  const bool good = width_height.size() == 2 &&
                    std::all_of(width_height.begin(), width_height.end(),
                                [](double v) { return v >= 16 && v <= 32768 && v == std::floor(v); });
  if (!good) {
    throw std::runtime_error(where + " must be [width, height] in pixels (16 to 32768), got " +
                             list_text(width_height));
  }
  camera.width_px = static_cast<int>(width_height[0]);
  camera.height_px = static_cast<int>(width_height[1]);
}

void set_pinhole(CameraIntrinsics& camera, double fx, double fy, double cx, double cy,
                 const std::string& where) {
  if (!(fx > 0) || !(fy > 0) || !std::isfinite(fx * fy) || !std::isfinite(cx) || !std::isfinite(cy)) {
    throw std::runtime_error(where + " must be [fx, fy, cx, cy] with focal lengths > 0 px, got " +
                             list_text({fx, fy, cx, cy}));
  }
  camera.fx_px = fx;
  camera.fy_px = fy;
  camera.cx_px = cx;
  camera.cy_px = cy;
}

void check_baseline(const StereoCalibration& calibration) {
  constexpr double kLongestM = 10;
  const double baseline_m = calibration.right_from_left.translation().norm();
  if (baseline_m > kLongestM) {
    throw std::runtime_error(calibration.origin + ": baseline must be at most 10 m, got " +
                             std::to_string(baseline_m) + "; is it in millimetres?");
  }
}

namespace {

/// Where a calibration does not say its resolution, the middle of its pictures tells: lenses sit over it.
void check_centre(const CameraIntrinsics& camera, const std::string& origin, const std::string& where) {
  constexpr double kLeast = 0.3, kMost = 0.7;
  const auto near_middle = [](double share) { return share > kLeast && share < kMost; };
  if (near_middle(camera.cx_px / camera.width_px) && near_middle(camera.cy_px / camera.height_px)) return;
  throw std::runtime_error(where + ": the optical centre of " + origin + ", " +
                           list_text({camera.cx_px, camera.cy_px}) +
                           " px, is far from the middle of pictures of " + std::to_string(camera.width_px) +
                           "x" + std::to_string(camera.height_px) + "; it is for another resolution");
}

}  // namespace

void fit_resolution(StereoCalibration& calibration, int width_px, int height_px, const std::string& where) {
  const auto size = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  for (CameraIntrinsics* camera : {&calibration.left, &calibration.right}) {
    if (camera->width_px == 0) {
      camera->width_px = width_px;
      camera->height_px = height_px;
      check_centre(*camera, calibration.origin, where);
    }
    if (camera->width_px == width_px && camera->height_px == height_px) continue;
    throw std::runtime_error(where + ": pictures are " + size(width_px, height_px) + ", but " +
                             calibration.origin + " is for " + size(camera->width_px, camera->height_px) +
                             "; calibrate at this resolution, or scale fx, fy, cx, cy");
  }
}

}  // namespace flogmap
