#include "camera/mcap/camera_info_message.hpp"

#include <bit>
#include <utility>

namespace flogmap::mcap {
namespace {

constexpr std::size_t kMostNumbers = 64;  // no lens model has more, no matrix either

std::vector<double> read_doubles(FieldReader& in, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count && in.ok(); ++i) values.push_back(in.number<double>());
  return values;
}

std::optional<RosCameraInfo> read_ros_info(Encoding encoding, ByteView message) {
  auto in = ros_fields(encoding, message);
  if (!in) return std::nullopt;
  RosCameraInfo info;
  (void)read_header(encoding, *in);
  info.height_px = in->number<std::uint32_t>();
  info.width_px = in->number<std::uint32_t>();
  info.distortion_model = in->text();
  const auto num_coefficients = in->number<std::uint32_t>();
  if (num_coefficients > kMostNumbers) return std::nullopt;
  info.distortion_coefficients = read_doubles(*in, num_coefficients);
  info.camera_matrix = read_doubles(*in, 9);
  info.rectification_matrix = read_doubles(*in, 9);
  info.projection_matrix = read_doubles(*in, 12);
  return in->ok() ? std::optional(std::move(info)) : std::nullopt;
}

/// A list of doubles comes packed into one field, or as one field for each.
void add_doubles(std::vector<double>& values, const ProtobufField& field) {
  FieldReader in(field.bytes);
  if (field.is_number) {
    if (values.size() < kMostNumbers) values.push_back(std::bit_cast<double>(field.value));
    return;
  }
  while (in.left() >= sizeof(double) && values.size() < kMostNumbers) values.push_back(in.number<double>());
}

/// The numbers of the fields are those of foxglove/CameraCalibration.proto.
std::optional<RosCameraInfo> read_foxglove_info(ByteView message) {
  enum : std::uint8_t { width = 2, height = 3, model = 4, d = 5, k = 6, r = 7, p = 8 };
  RosCameraInfo info;
  while (const auto field = next_field(message)) {
    if (field->number == width) info.width_px = static_cast<std::uint32_t>(field->value);
    if (field->number == height) info.height_px = static_cast<std::uint32_t>(field->value);
    if (field->number == model) info.distortion_model.assign(field->bytes.begin(), field->bytes.end());
    if (field->number == d) add_doubles(info.distortion_coefficients, *field);
    if (field->number == k) add_doubles(info.camera_matrix, *field);
    if (field->number == r) add_doubles(info.rectification_matrix, *field);
    if (field->number == p) add_doubles(info.projection_matrix, *field);
  }
  return message.empty() ? std::optional(std::move(info)) : std::nullopt;
}

}  // namespace

std::optional<RosCameraInfo> read_camera_info(MessageKind kind, ByteView message, std::string origin) {
  auto info = kind.encoding == Encoding::protobuf ? read_foxglove_info(message)
                                                  : read_ros_info(kind.encoding, message);
  if (info) info->origin = std::move(origin);
  return info;
}

bool is_calibrated(const RosCameraInfo& info) {
  return !info.camera_matrix.empty() && info.camera_matrix.front() != 0;
}

}  // namespace flogmap::mcap
