#include "camera/recording_writer.hpp"

#include <array>
#include <bit>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "camera/picture_files.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file) {
  throw std::runtime_error(file.string() + ": cannot be written; is the disk full?");
}

void add_line(std::ofstream& out, const std::string& line, const fs::path& file) {
  out << line << '\n' << std::flush;
  if (!out) fail(file);
}

const char* model_name(Distortion distortion) {
  switch (distortion) {
    case Distortion::rational:
      return "rational_polynomial";
    case Distortion::equidistant:
      return "equidistant";
    case Distortion::none:
    case Distortion::radtan:
      break;
  }
  return "radial-tangential";
}

std::string list_text(const std::vector<double>& values) {
  std::ostringstream out;
  out << std::setprecision(17) << '[';
  for (std::size_t i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
  out << ']';
  return out.str();
}

std::string transform_text(const Eigen::Isometry3d& transform, const std::string& name = "T_BS") {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = transform.matrix();
  return name +
         ":\n  cols: 4\n  rows: 4\n  data: " + list_text(std::vector<double>(m.data(), m.data() + 16)) + "\n";
}

std::string sensor_yaml(const CameraIntrinsics& camera, const Eigen::Isometry3d& body_from_camera,
                        bool rectified, double rate_hz) {
  const std::vector<double> coefficients =
      camera.coefficients.empty() ? std::vector<double>(4, 0.0) : camera.coefficients;
  std::ostringstream out;
  out << "sensor_type: camera\n" << transform_text(body_from_camera);
  if (rate_hz > 0) out << "rate_hz: " << rate_hz << "\n";
  out << "resolution: [" << camera.width_px << ", " << camera.height_px << "]\ncamera_model: pinhole\n"
      << "intrinsics: " << list_text({camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}) << "\n"
      << "distortion_model: " << model_name(camera.distortion) << "\n"
      << "distortion_coefficients: " << list_text(coefficients) << "\n";
  if (rectified) out << "rectified: true\n";
  return out.str();
}

/// A name without a folder lies in the current one, which is there.
void make_folder_of(const fs::path& file) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
}

void write_text(const fs::path& file, const std::string& text) {
  make_folder_of(file);
  std::ofstream out(file, std::ios::binary);
  out << text << std::flush;
  if (!out) fail(file);
}

std::ofstream open_list(const fs::path& file, const std::string& header) {
  write_text(file, header);
  return std::ofstream(file, std::ios::binary | std::ios::app);
}

constexpr const char* kTruthHeader =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
    "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], "
    "b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n";

}  // namespace

std::string seconds_text(std::int64_t timestamp_ns) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const std::int64_t whole = timestamp_ns / kNsPerS, rest = timestamp_ns % kNsPerS;
  std::ostringstream out;
  out << whole << '.' << std::setw(9) << std::setfill('0') << rest;
  return out.str();
}

void write_pfm(const fs::path& file, const Image<float>& image) {
  make_folder_of(file);
  std::ofstream out(file, std::ios::binary);
  out << "Pf\n" << image.width << ' ' << image.height << "\n-1.0\n";
  for (int y = image.height - 1; y >= 0; --y) {
    for (int x = 0; x < image.width; ++x) {
      const auto bits = std::bit_cast<std::uint32_t>(image.at(x, y));
      for (int byte = 0; byte < 4; ++byte) out.put(static_cast<char>(bits >> (8 * byte)));
    }
  }
  if (!out.flush()) fail(file);
}

void RecordingWriter::require_free(const fs::path& folder) {
  if (!fs::exists(folder / "mav0" / "cam0" / "data.csv")) return;
  throw std::runtime_error(folder.string() + ": there is a recording already; choose another folder");
}

RecordingWriter::RecordingWriter(fs::path folder, const StereoCalibration& calibration, Options options)
    : folder_(std::move(folder)),
      left_from_body_(calibration.body_from_left.inverse()),
      options_(std::move(options)) {
  const fs::path cam0 = folder_ / "mav0" / "cam0", cam1 = folder_ / "mav0" / "cam1";
  require_free(folder_);
  std::error_code error;
  for (const fs::path& camera : {cam0, cam1}) fs::create_directories(camera / "data", error);
  if (error) throw std::runtime_error(folder_.string() + ": cannot be created: " + error.message());
  const Eigen::Isometry3d body_from_right =
      calibration.body_from_left * calibration.right_from_left.inverse();
  const bool rectified = calibration.rectified;
  std::string left_yaml =
      sensor_yaml(calibration.left, calibration.body_from_left, rectified, options_.rate_hz);
  if (const auto& up = options_.up_in_left_camera)
    left_yaml += "up_in_camera: " + list_text({up->x(), up->y(), up->z()}) + "\n";
  write_text(cam0 / "sensor.yaml", left_yaml);
  // T_BS says it too, but not to the last bit.
  write_text(cam1 / "sensor.yaml",
             sensor_yaml(calibration.right, body_from_right, rectified, options_.rate_hz) +
                 transform_text(calibration.right_from_left, "right_from_left"));
  left_csv_ = open_list(cam0 / "data.csv", "#timestamp [ns],filename\n");
  right_csv_ = open_list(cam1 / "data.csv", "#timestamp [ns],filename\n");
  if (!options_.about.empty()) write_text(folder_ / "recording.json", options_.about + "\n");
}

void RecordingWriter::write_picture_whole(const fs::path& file, const Picture& picture) const {
  const fs::path unfinished = file.parent_path() / ("unfinished" + file.extension().string());
  std::error_code error;
  if (!write_picture(unfinished, picture)) {
    fs::remove(unfinished, error);  // makes room for the last lines of the lists
    fail(file);
  }
  fs::rename(unfinished, file, error);
  if (error) fail(file);
}

void RecordingWriter::write(const StereoFrame& frame,
                            const std::optional<Eigen::Isometry3d>& world_from_left) {
  const std::string time = std::to_string(frame.timestamp_ns);
  const char* plain = frame.left.channels == 1 ? ".pgm" : ".ppm";
  const std::string name = time + (!options_.compress ? plain : options_.lossy ? ".jpg" : ".png");
  const fs::path cam0 = folder_ / "mav0" / "cam0", cam1 = folder_ / "mav0" / "cam1";
  write_picture_whole(cam0 / "data" / name, frame.left);
  write_picture_whole(cam1 / "data" / name, frame.right);
  add_line(right_csv_, time + "," + name, cam1 / "data.csv");
  add_line(left_csv_, time + "," + name, cam0 / "data.csv");
  if (frame.details != CaptureDetails{}) write_details(frame);
  if (world_from_left) write_pose(frame.timestamp_ns, *world_from_left);
  ++num_written_;
}

void RecordingWriter::write_details(const StereoFrame& frame) {
  const fs::path csv = folder_ / "mav0" / "capture.csv";
  if (!capture_csv_.is_open())
    capture_csv_ = open_list(csv, "#timestamp [ns],right - left [ns],exposure [us],gain\n");
  std::ostringstream line;
  line << frame.timestamp_ns << ',' << frame.details.skew_ns << ',' << frame.details.exposure_us << ','
       << frame.details.gain;
  add_line(capture_csv_, line.str(), csv);
}

void RecordingWriter::write_pose(std::int64_t timestamp_ns, const Eigen::Isometry3d& world_from_left) {
  const fs::path csv = folder_ / "mav0" / "state_groundtruth_estimate0" / "data.csv";
  const fs::path tum = folder_ / "groundtruth.tum";
  if (!truth_csv_.is_open()) {
    write_text(csv.parent_path() / "sensor.yaml",
               "sensor_type: visual-inertial\ncomment: exact poses, world_from_body\n" +
                   transform_text(Eigen::Isometry3d::Identity()));
    truth_csv_ = open_list(csv, kTruthHeader);
    truth_tum_ = open_list(tum, "");
  }
  const auto text = [](const Eigen::Vector3d& p, const std::array<double, 4>& q, const char* separator) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(9);
    for (const double value : {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}) out << separator << value;
    return out.str();
  };
  const Eigen::Isometry3d world_from_body = world_from_left * left_from_body_;
  const Eigen::Quaterniond body(world_from_body.linear()), left(world_from_left.linear());
  const std::string body_text =
      text(world_from_body.translation(), {body.w(), body.x(), body.y(), body.z()}, ",");
  add_line(truth_csv_, std::to_string(timestamp_ns) + body_text + ",0,0,0,0,0,0,0,0,0", csv);
  add_line(truth_tum_,
           seconds_text(timestamp_ns) +
               text(world_from_left.translation(), {left.x(), left.y(), left.z(), left.w()}, " "),
           tum);
}

}  // namespace flogmap
