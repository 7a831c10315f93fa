#include "camera/mcap/image_message.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

namespace flogmap::mcap {
namespace {

constexpr int kAsItIs = -1;

/// A pixel encoding of sensor_msgs, and the conversion to grey, or to blue, green, red.
struct PixelEncoding {
  std::string_view name;
  int type;        // OpenCV's
  int conversion;  // OpenCV's; it names colour filters by their second row, from the second pixel on
};
constexpr std::array kEncodings{
    PixelEncoding{"mono8", CV_8UC1, kAsItIs},
    PixelEncoding{"8UC1", CV_8UC1, kAsItIs},
    PixelEncoding{"mono16", CV_16UC1, kAsItIs},
    PixelEncoding{"16UC1", CV_16UC1, kAsItIs},
    PixelEncoding{"bgr8", CV_8UC3, kAsItIs},
    PixelEncoding{"8UC3", CV_8UC3, kAsItIs},
    PixelEncoding{"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    PixelEncoding{"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    PixelEncoding{"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    PixelEncoding{"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    PixelEncoding{"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    PixelEncoding{"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    PixelEncoding{"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
};

std::string allowed_encodings() {
  std::string names;
  for (const PixelEncoding& entry : kEncodings)
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

std::optional<ImageMessage> read_ros_image(MessageKind kind, ByteView message) {
  auto in = ros_fields(kind.encoding, message);
  if (!in) return std::nullopt;
  ImageMessage image;
  image.stamp_ns = read_header(kind.encoding, *in);
  image.compressed = kind.meaning == Meaning::compressed_image;
  if (!image.compressed) {
    image.height = in->number<std::uint32_t>();
    image.width = in->number<std::uint32_t>();
  }
  image.encoding = in->text();
  if (!image.compressed) {
    image.big_endian = in->number<std::uint8_t>() != 0;
    image.step = in->number<std::uint32_t>();
  }
  image.data = in->counted_bytes();
  return in->ok() ? std::optional(image) : std::nullopt;
}

std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The numbers of the fields are those of foxglove/RawImage.proto and CompressedImage.proto.
std::optional<ImageMessage> read_foxglove_image(MessageKind kind, ByteView message) {
  enum : std::uint8_t { time = 1, width = 2, height = 3, encoding = 4, step = 5, data = 6 };
  enum : std::uint8_t { compressed_data = 2, format = 3 };
  ImageMessage image;
  image.compressed = kind.meaning == Meaning::compressed_image;
  while (const auto field = next_field(message)) {
    const auto number = static_cast<std::uint32_t>(field->value);
    if (field->number == time) {
      image.stamp_ns = read_protobuf_time(field->bytes);
    } else if (image.compressed) {
      if (field->number == compressed_data) image.data = field->bytes;
      if (field->number == format) image.encoding = text_of(field->bytes);
    } else {
      if (field->number == width) image.width = number;
      if (field->number == height) image.height = number;
      if (field->number == encoding) image.encoding = text_of(field->bytes);
      if (field->number == step) image.step = number;
      if (field->number == data) image.data = field->bytes;
    }
  }
  return message.empty() ? std::optional(image) : std::nullopt;  // else it ends in the middle of a field
}

/// The rows, without what pads them.
Picture packed_rows(const ImageMessage& image, const PixelEncoding& encoding) {
  const bool is_16_bit = CV_MAT_DEPTH(encoding.type) == CV_16U;
  Picture picture{static_cast<int>(image.width),
                  static_cast<int>(image.height),
                  CV_MAT_CN(encoding.type),
                  is_16_bit ? 16 : 8,
                  {}};
  const std::size_t row_bytes = std::size_t{image.width} * CV_ELEM_SIZE(encoding.type);
  picture.bytes.resize(row_bytes * image.height);
  for (std::uint32_t y = 0; y < image.height; ++y)
    std::memcpy(picture.bytes.data() + y * row_bytes, image.data.data() + y * std::size_t{image.step},
                row_bytes);
  if (is_16_bit && image.big_endian) {
    for (std::size_t i = 0; i + 1 < picture.bytes.size(); i += 2)
      std::swap(picture.bytes[i], picture.bytes[i + 1]);
  }
  return picture;
}

Picture converted(Picture& picture, const PixelEncoding& encoding) {
  Picture result{picture.width, picture.height, 3, 8, {}};
  result.bytes.resize(std::size_t{3} * picture.width * picture.height);
  const cv::Mat from(picture.height, picture.width, encoding.type, picture.bytes.data());
  cv::Mat to(picture.height, picture.width, CV_8UC3, result.bytes.data());
  cv::cvtColor(from, to, encoding.conversion);
  return result;
}

ReadPicture decode_raw(const ImageMessage& image) {
  const auto* entry = std::find_if(kEncodings.begin(), kEncodings.end(),
                                   [&](const PixelEncoding& known) { return known.name == image.encoding; });
  if (entry == kEncodings.end()) {
    constexpr std::size_t kShown = 40;  // of what may be anything
    return {{},
            "encoding must be one of " + allowed_encodings() + ", got '" +
                std::string(image.encoding.substr(0, kShown)) + "'"};
  }
  constexpr std::uint32_t kLeast = 2, kMost = 32768;  // colour filters repeat after two pixels
  const bool sized =
      image.width >= kLeast && image.height >= kLeast && image.width <= kMost && image.height <= kMost;
  const std::uint64_t row_bytes = std::uint64_t{image.width} * CV_ELEM_SIZE(entry->type);
  // Rows may be padded, the last one need not be.
  const std::uint64_t needed = (std::uint64_t{image.height} - 1) * image.step + row_bytes;
  if (!sized || image.step < row_bytes || image.data.size() < needed) {
    return {{},
            std::to_string(image.width) + "x" + std::to_string(image.height) + " px of " +
                std::string(image.encoding) + " with " + std::to_string(image.step) +
                " bytes per row do not fit into its " + std::to_string(image.data.size()) + " bytes"};
  }
  Picture picture = packed_rows(image, *entry);
  return {entry->conversion == kAsItIs ? std::move(picture) : converted(picture, *entry), {}};
}

}  // namespace

std::optional<ImageMessage> read_image_message(MessageKind kind, ByteView message) {
  return kind.encoding == Encoding::protobuf ? read_foxglove_image(kind, message)
                                             : read_ros_image(kind, message);
}

ReadPicture decode_image(const ImageMessage& image) {
  if (!image.compressed) return decode_raw(image);
  return decode_picture({image.data.begin(), image.data.end()});
}

}  // namespace flogmap::mcap
