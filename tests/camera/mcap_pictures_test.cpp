// What pictures and calibrations look like in messages, and which topics are taken.
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "camera/mcap/topics.hpp"
#include "tests/camera/mcap_recording.hpp"

namespace flogmap {
namespace {

using namespace testing;
using ::testing::HasSubstr;

class McapPictures : public McapRecordings {
 protected:
  /// The left picture of a file whose pictures are all this message's.
  Picture read_back(const std::function<std::string(std::int64_t stamp_ns)>& message,
                    const std::string& type = "Image", Dialect dialect = Dialect::cdr_little) {
    McapWriter out;
    for (const char* topic : {"/left/image_raw", "/right/image_raw"})
      out.add_channel(topic, schema_name(dialect, type), encoding_name(dialect));
    for (const int side : {1, 2}) out.add_message(side, kStart, message(kStart));
    const auto source = open_source({.spec = spec_of(out.finish()), .needs_calibration = false});
    const auto frame = source->next();
    return frame ? frame->left : Picture{};
  }

  /// No two pixels alike.
  static Picture colourful(int channels, int bits = 8) {
    Picture picture{32, 24, channels, bits, {}};
    picture.bytes.resize(std::size_t{32} * 24 * channels * bits / 8);
    for (std::size_t i = 0; i < picture.bytes.size(); ++i)
      picture.bytes[i] = static_cast<std::uint8_t>((i * 37) ^ (i >> 8U));
    return picture;
  }
};

TEST_F(McapPictures, RowsComeBackWithoutTheirPadding) {
  for (const Dialect dialect : {Dialect::cdr_little, Dialect::cdr_big, Dialect::ros1, Dialect::foxglove}) {
    for (const std::uint32_t padding : {0, 3, 32}) {
      for (const auto& [encoding, channels, bits] :
           {std::tuple("mono8", 1, 8), {"8UC1", 1, 8}, {"bgr8", 3, 8}, {"mono16", 1, 16}, {"16UC1", 1, 16}}) {
        const Picture picture = colourful(channels, bits);
        EXPECT_EQ(
            read_back([&](auto t) { return image_message(dialect, sent(picture, t, encoding, padding)); },
                      "Image", dialect),
            picture)
            << encoding << padding;
      }
    }
  }
}

TEST_F(McapPictures, ColoursInAnyOrderBecomeBlueGreenRed) {
  const Picture expected = colourful(3);
  for (const std::string order : {"rgb8", "rgba8", "bgra8"}) {
    Picture stored{32, 24, order.size() == 5 ? 4 : 3, 8, {}};
    for (std::size_t i = 0; i < expected.bytes.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c)
        stored.bytes.push_back(expected.bytes[i + (order[0] == 'r' ? 2 - c : c)]);
      if (stored.channels == 4) stored.bytes.push_back(17);
    }
    EXPECT_EQ(read_back([&](auto t) { return image_message({}, sent(stored, t, order)); }), expected)
        << order;
  }
}

TEST_F(McapPictures, ColourFiltersAreInterpolated) {
  const std::map<char, std::uint8_t> colour{{'b', 40}, {'g', 120}, {'r', 200}};
  for (const std::string filter : {"rggb", "bggr", "gbrg", "grbg"}) {
    Picture mosaic = grey_picture(0);
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 32; ++x) mosaic.bytes[y * 32 + x] = colour.at(filter[y % 2 * 2 + x % 2]);
    const Picture picture =
        read_back([&](auto t) { return image_message({}, sent(mosaic, t, "bayer_" + filter + "8")); });
    ASSERT_EQ(picture.channels, 3);
    const std::size_t middle = 3 * (12 * 32 + 15);
    for (std::size_t i = middle; i < middle + 6; i += 3) {
      EXPECT_EQ(picture.bytes[i], 40) << filter;
      EXPECT_EQ(picture.bytes[i + 1], 120) << filter;
      EXPECT_EQ(picture.bytes[i + 2], 200) << filter;
    }
  }
}

TEST_F(McapPictures, SixteenBitsOfEitherOrderAreTheSameAndLowOnesAreShiftedUp) {
  Picture picture = colourful(1, 16);
  for (std::size_t i = 1; i < picture.bytes.size(); i += 2) picture.bytes[i] &= 0x0FU;  // 12 bits
  Picture expected = picture;
  for (std::size_t i = 0; i < picture.bytes.size(); i += 2) {
    std::uint16_t value = 0;
    std::memcpy(&value, &picture.bytes[i], 2);
    value = static_cast<std::uint16_t>(value << 4U);
    std::memcpy(&expected.bytes[i], &value, 2);
  }
  Picture swapped = picture;
  for (std::size_t i = 0; i < picture.bytes.size(); i += 2) std::swap(swapped.bytes[i], swapped.bytes[i + 1]);
  EXPECT_EQ(read_back([&](auto t) { return image_message({}, sent(picture, t, "mono16")); }), expected);
  const auto big = [&](auto t) {
    SentImage image = sent(swapped, t, "mono16");
    image.big_endian = true;
    return image_message({}, image);
  };
  EXPECT_EQ(read_back(big), expected);
}

TEST_F(McapPictures, CompressedPicturesAreDecoded) {
  for (const Dialect dialect : {Dialect::cdr_little, Dialect::cdr_big, Dialect::ros1, Dialect::foxglove}) {
    for (const int channels : {1, 3}) {
      const Picture picture = colourful(channels);
      std::vector<std::uint8_t> png;
      cv::imencode(".png", cv::Mat(24, 32, CV_8UC(channels), const_cast<std::uint8_t*>(picture.bytes.data())),
                   png);
      const auto message = [&](auto t) {
        return compressed_message(dialect, t, "mono8; png compressed mono8", {png.begin(), png.end()});
      };
      EXPECT_EQ(read_back(message, "CompressedImage", dialect), picture);
    }
  }
}

TEST_F(McapPictures, WhatNoPictureCanBeIsNamed) {
  const auto refused = [&](const std::function<std::string(std::int64_t)>& message, const std::string& why,
                           const std::string& type = "Image") {
    EXPECT_THAT([&] { (void)read_back(message, type); },
                ::testing::ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  };
  SentImage image = sent(grey_picture(1), kStart, "yuv444");
  const auto message = [&](auto) { return image_message({}, image); };
  refused(message, "must be one of mono8");
  image = sent(grey_picture(1), kStart);
  image.height = 25;
  refused(message, "32x25 px of mono8 with 32 bytes per row do not fit into its 768 bytes");
  image.height = 24, image.step = 31;
  refused(message, "do not fit");
  image.step = 0xFFFFFFFFU, image.height = 0xFFFFFFFFU, image.width = 0xFFFFFFFFU;
  refused(message, "do not fit");
  image.width = 0, image.height = 0;
  refused(message, "do not fit");
  refused([](auto) { return std::string("\0\1\0\0", 4); }, "no stereo pair");
  refused([](auto) { return std::string(); }, "not what its type says");
  refused([](auto t) { return compressed_message({}, t, "jpeg", "\xFF\xD8\xFF"); }, "truncated JPEG",
          "CompressedImage");
}

TEST_F(McapPictures, CalibrationsComeFromTheTopicsBeside) {
  const auto file = [](const std::string& image, const RosCameraInfo& left, const RosCameraInfo& right) {
    McapWriter out;
    for (const char* side : {"/left/", "/right/"}) {
      out.add_channel(side + image, "sensor_msgs/msg/Image", "cdr");
      out.add_channel(std::string(side) + "camera_info", "sensor_msgs/msg/CameraInfo", "cdr");
    }
    for (const int id : {1, 3}) out.add_message(id, kStart, picture_message({}, 1, kStart));
    out.add_message(2, kStart, info_message({}, left));
    out.add_message(4, kStart, info_message({}, right));
    return out.finish();
  };
  RosCameraInfo left = info(0), right = info(0.1);
  left.distortion_coefficients = right.distortion_coefficients = {0.1, 0, 0, 0, 0};
  left.projection_matrix[0] = left.projection_matrix[5] = 18;
  const auto raw = open_file(file("image_raw", left, right))->calibration();
  EXPECT_EQ(raw->left.distortion, Distortion::radtan);
  EXPECT_EQ(raw->left.fx_px, 20);
  EXPECT_FALSE(raw->rectified);
  const auto rectified = open_file(file("image_rect", left, right))->calibration();
  EXPECT_EQ(rectified->left.distortion, Distortion::none);
  EXPECT_EQ(rectified->left.fx_px, 18);
  EXPECT_TRUE(rectified->rectified);
  EXPECT_NEAR(rectified->right_from_left.translation().x(), -0.1, 1e-12);
  expect_file_refused(file("image_raw", left, left), "/right/camera_info: projection_matrix[3]");
  right.rectification_matrix[0] = 3;
  expect_file_refused(file("image_raw", left, right), "/right/camera_info: rectification_matrix");
  right = info(0.1);
  right.camera_matrix.assign(9, 0);  // a driver that has no calibration
  EXPECT_FALSE(open_file(file("image_raw", left, right))->calibration());
  const std::string kitti = folder_.write("calib.txt",
                                          "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\n"
                                          "P1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n");
  const auto given = open_source({.spec = spec_of(file("image_raw", left, left)), .calibration_file = kitti});
  EXPECT_NEAR(given->calibration()->right_from_left.translation().x(), -0.2, 1e-12);
}

mcap::Topic topic(const std::string& name) {
  using mcap::Meaning;
  const bool is_info = name.ends_with("info"), is_packed = name.ends_with("compressed");
  return {name,
          "a type",
          {.meaning = is_info     ? Meaning::camera_info
                      : is_packed ? Meaning::compressed_image
                                  : Meaning::image}};
}

std::string chosen(const std::vector<std::string>& names) {
  std::vector<mcap::Topic> topics;
  for (const std::string& name : names) topics.push_back(topic(name));
  try {
    const mcap::TopicPair pair = mcap::choose_topics(topics, "FILE");
    const auto infos = mcap::info_topics(topics, pair);
    return pair.left.name + " " + pair.right.name + (infos ? " " + infos->right.name : "");
  } catch (const std::runtime_error& refused) {
    return refused.what();
  }
}

TEST(McapTopics, TheTwoCamerasAreChosenByTheirNames) {
  EXPECT_EQ(chosen({"/right/image_raw", "/left/image_raw", "/imu"}), "/left/image_raw /right/image_raw");
  EXPECT_EQ(chosen({"/cam0/image_raw", "/cam1/image_raw", "/cam1/camera_info", "/cam0/camera_info"}),
            "/cam0/image_raw /cam1/image_raw /cam1/camera_info");
  EXPECT_EQ(chosen({"/camera/infra1/image_rect_raw", "/camera/infra2/image_rect_raw",
                    "/camera/color/image_raw", "/camera/depth/image_rect_raw"}),
            "/camera/infra1/image_rect_raw /camera/infra2/image_rect_raw");
  EXPECT_EQ(chosen({"/s/left/image_rect", "/s/right/image_rect", "/s/left/image_raw", "/s/right/image_raw",
                    "/s/left/image_raw/compressed", "/s/right/image_raw/compressed"}),
            "/s/left/image_raw /s/right/image_raw");
  EXPECT_EQ(chosen({"/s/left/image_rect", "/s/right/image_rect", "/s/left/image_raw/compressed",
                    "/s/right/image_raw/compressed", "/s/left/camera_info", "/s/right/camera_info"}),
            "/s/left/image_raw/compressed /s/right/image_raw/compressed /s/right/camera_info");
}

TEST(McapTopics, WhatIsNotClearIsAskedInOneLineWithTheTopics) {
  EXPECT_THAT(
      chosen({"/a/left/image_raw", "/a/right/image_raw", "/b/left/image_raw", "/b/right/image_raw"}),
      ::testing::AllOf(HasSubstr("/b/right/image_raw (a type)"), HasSubstr("could be the left camera"),
                       HasSubstr("mcap:FILE,LEFT_TOPIC,RIGHT_TOPIC")));
  EXPECT_THAT(chosen({"/front/image_raw", "/back/image_raw"}),
              ::testing::AllOf(HasSubstr("called left and right"), HasSubstr("/front/image_raw (a type)")));
  EXPECT_THAT(chosen({"/left/camera_info"}), HasSubstr("holds no pictures"));
}

}  // namespace
}  // namespace flogmap
