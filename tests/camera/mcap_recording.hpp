#pragma once

#include <gmock/gmock.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/camera/mcap_writer.hpp"
#include "tests/camera/recording_folder.hpp"

namespace flogmap::testing {

/// The frames of the small EuRoC recording as messages, 10 ms after they were taken.
class McapRecordings : public Recordings {
 protected:
  static constexpr std::int64_t kDelay = 10'000'000;

  /// What the recording's sensor.yaml files say, as camera_info.
  static RosCameraInfo info(double baseline_m) {
    return {.origin = {},
            .width_px = 32,
            .height_px = 24,
            .distortion_model = "plumb_bob",
            .distortion_coefficients = {0, 0, 0, 0, 0},
            .camera_matrix = {20, 0, 15.5, 0, 20, 11.5, 0, 0, 1},
            .rectification_matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1},
            .projection_matrix = {20, 0, 15.5, -20 * baseline_m, 0, 20, 11.5, 0, 0, 0, 1, 0}};
  }

  static std::int64_t time_of(int i) { return kStart + i * kPeriod; }
  static std::string picture_message(Dialect dialect, int tone, std::int64_t stamp_ns) {
    return image_message(dialect, sent(grey_picture(tone), stamp_ns));
  }

  /// Channels of two cameras: pictures left (1) and right (2), camera_info left (3) and right (4).
  static McapWriter writer(const McapLayout& layout, Dialect dialect = Dialect::cdr_little) {
    McapWriter out(layout);
    for (const char* type : {"Image", "CameraInfo"}) {
      for (const char* side : {"left", "right"}) {
        const std::string name = *type == 'I' ? "/image_raw" : "/camera_info";
        out.add_channel("/stereo/" + std::string(side) + name, schema_name(dialect, type),
                        encoding_name(dialect));
      }
    }
    out.add_message(3, kStart, info_message(dialect, info(0)));
    out.add_message(4, kStart, info_message(dialect, info(0.1)));
    return out;
  }
  static void add_pair(McapWriter& out, int i, Dialect dialect = Dialect::cdr_little) {
    for (const int side : {1, 2}) {
      out.add_message(side, time_of(i) + kDelay + side,
                      picture_message(dialect, 10 * i + side - 1, time_of(i)));
    }
  }
  static McapWriter five_pairs(const McapLayout& layout, Dialect dialect = Dialect::cdr_little) {
    McapWriter out = writer(layout, dialect);
    for (int i = 0; i < 5; ++i) add_pair(out, i, dialect);
    return out;
  }

  /// A new file each time: file systems take one that is emptied and written again for precious, and wait for
  /// the disk.
  std::string spec_of(const std::string& file) {
    std::filesystem::remove(folder_.path() / "bag.mcap");
    return "mcap:" + folder_.write("bag.mcap", file).string();
  }
  std::unique_ptr<StereoSource> open_file(const std::string& file, const std::string& topics = "") {
    return open_source({.spec = spec_of(file) + topics});
  }
  void expect_file_refused(const std::string& file, const std::string& why, const std::string& topics = "") {
    EXPECT_THAT([&] { static_cast<void>(open_file(file, topics)); },
                ::testing::ThrowsMessage<std::runtime_error>(
                    ::testing::AllOf(::testing::HasSubstr(why), ::testing::Not(::testing::HasSubstr("\n")))));
  }

  static std::vector<McapLayout> all_layouts() {
    std::vector<McapLayout> layouts;
    for (const bool summary : {true, false}) {
      layouts.push_back({.chunks = false, .summary = summary});
      for (const char* compression : {"", "lz4", "zstd"}) {
        for (const int count : {1, 4, 100}) {
          layouts.push_back({.compression = compression,
                             .summary = summary,
                             .checksums = count != 4,
                             .messages_per_chunk = count});
        }
      }
    }
    return layouts;
  }
  static std::string name_of(const McapLayout& layout) {
    return (layout.chunks ? "chunks of " + std::to_string(layout.messages_per_chunk) : "no chunks") + " " +
           layout.compression + (layout.summary ? "" : " without summary");
  }
};

}  // namespace flogmap::testing
