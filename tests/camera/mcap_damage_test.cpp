// Files of killed recorders, broken disks and strangers: what was read is right, the rest is counted.
#include <chrono>
#include <cstring>
#include <random>

#include "tests/camera/mcap_recording.hpp"

namespace flogmap {
namespace {

using namespace testing;
using ::testing::HasSubstr;

class DamagedMcap : public McapRecordings {
 protected:
  /// Numbers of the frames that a file gives, each of which must be as it was; nothing if it is refused.
  std::vector<int> frames_of(const std::string& file, bool pictures_are_checked = true) {
    std::vector<int> frames;
    try {
      const auto source = open_file(file);
      std::int64_t last_ns = -1;
      while (const auto frame = source->next()) {
        EXPECT_GT(frame->timestamp_ns, last_ns);
        last_ns = frame->timestamp_ns;
        const auto i = static_cast<int>((frame->timestamp_ns - kStart) / kPeriod);
        if (pictures_are_checked) {
          EXPECT_EQ(frame->timestamp_ns, time_of(i));
          EXPECT_EQ(frame->left, grey_picture(10 * i));
          EXPECT_EQ(frame->right, grey_picture(10 * i + 1));
        }
        frames.push_back(i);
      }
    } catch (const std::runtime_error& refused) {
      EXPECT_THAT(refused.what(), ::testing::Not(HasSubstr("\n")));
    }
    return frames;
  }
};

TEST_F(DamagedMcap, AFileCutAnywhereGivesWhatWasWrittenBefore) {
  std::vector<McapLayout> layouts{{.chunks = false}};
  for (const char* compression : {"", "lz4", "zstd"})
    layouts.push_back({.compression = compression, .messages_per_chunk = 2});
  for (const McapLayout& layout : layouts) {
    SCOPED_TRACE(name_of(layout));
    McapWriter out = writer(layout);
    std::vector<std::size_t> ends;  // of the file when a pair was written
    for (int i = 0; i < 3; ++i) {
      add_pair(out, i);
      ends.push_back(out.unfinished().size());
    }
    const std::string file = out.finish();
    for (std::size_t size = 0; size < file.size(); ++size) {
      const std::vector<int> frames = frames_of(file.substr(0, size));
      const auto written = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin();
      // Behind a chunk come records that say nothing new: its pair is there before they are.
      ASSERT_GE(std::ssize(frames), written) << "cut to " << size;
      ASSERT_LE(std::ssize(frames), written + 1) << "cut to " << size;
    }
  }
}

TEST_F(DamagedMcap, ACutFileSaysSo) {
  const std::string whole = five_pairs({.messages_per_chunk = 2}).finish();
  EXPECT_EQ(open_file(whole)->info().assumed, "");
  const auto cut = open_file(whole.substr(0, whole.size() * 3 / 5));
  EXPECT_THAT(cut->info().assumed, HasSubstr("bag.mcap: cut off or damaged at byte "));
  EXPECT_EQ(times(*cut).size(), static_cast<std::size_t>(*cut->info().num_frames));
  EXPECT_LT(cut->info().last_timestamp_ns, time_of(4));
}

TEST_F(DamagedMcap, WrongBytesNeverMakeWrongPicturesWhereThereAreChecksums) {
  std::mt19937 random(20261123);
  for (const char* compression : {"", "lz4", "zstd"}) {
    const std::string file = five_pairs({.compression = compression, .messages_per_chunk = 2}).finish();
    for (int round = 0; round < 600; ++round) {
      std::string bad = file;
      const std::size_t count = 1 + random() % 4;
      for (std::size_t i = 0; i < count; ++i) bad[random() % bad.size()] = static_cast<char>(random());
      (void)frames_of(bad);
    }
  }
}

TEST_F(DamagedMcap, WrongBytesAreSurvivedWhereThereAreNone) {
  std::mt19937 random(20261124);
  for (const bool chunks : {true, false}) {
    const std::string file = five_pairs({.chunks = chunks, .checksums = false}).finish();
    for (int round = 0; round < 600; ++round) {
      std::string bad = file;
      for (int i = 0; i < 6; ++i) bad[random() % bad.size()] = static_cast<char>(random());
      (void)frames_of(bad, false);
    }
  }
}

TEST_F(DamagedMcap, LengthsBeyondAllBoundsCostNoMemoryAndNoTime) {
  for (const McapLayout& layout : {McapLayout{.chunks = false}, McapLayout{.compression = "zstd"}}) {
    const std::string file = five_pairs(layout).finish();
    const auto start = std::chrono::steady_clock::now();
    for (const char byte : {'\xFF', '\x7F'}) {
      for (std::size_t at = 8; at + 8 <= file.size(); at += 3) {
        std::string bad = file;
        std::memset(bad.data() + at, byte, 8);
        (void)frames_of(bad, false);
      }
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  }
}

TEST_F(DamagedMcap, ADamagedChunkCostsItsPairsAndIsCounted) {
  for (const bool summary : {true, false}) {
    McapWriter out = writer({.summary = summary, .messages_per_chunk = 2});
    for (int i = 0; i < 2; ++i) add_pair(out, i);
    const std::size_t before = out.unfinished().size();
    add_pair(out, 2);
    const std::size_t after = out.unfinished().size();
    for (int i = 3; i < 5; ++i) add_pair(out, i);
    std::string file = out.finish();
    file[(before + after) / 2] ^= 1;
    const auto source = open_file(file);
    EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 3, 4));
    EXPECT_EQ(source->skipped().count, 1);
    EXPECT_THAT(source->skipped().last_reason, HasSubstr("checksum differs"));
  }
}

TEST_F(DamagedMcap, AChunkThatClaimsToBeHugeIsRefusedBeforeMemoryIsTaken) {
  McapWriter out = writer({.summary = false});
  for (int i = 0; i < 5; ++i) add_pair(out, i);
  out.end_chunk();
  for (const char* compression : {"zstd", "lz4", "", "snappy"}) {
    for (const std::uint64_t size : {std::uint64_t{1} << 40U, ~std::uint64_t{0}, std::uint64_t{1} << 28U}) {
      out.add_record(6, FieldWriter()
                            .number(std::uint64_t{1})
                            .number(std::uint64_t{2})
                            .number(size)
                            .number(std::uint32_t{0})
                            .text(compression)
                            .number(std::uint64_t{20})
                            .raw(std::string(20, '\x28'))
                            .bytes());
    }
  }
  const auto source = open_file(out.finish());
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(source->skipped().count, 12);
}

TEST_F(DamagedMcap, PicturesThatCannotBeReadAreSkippedAndNamed) {
  McapWriter out = writer({});
  for (int i = 0; i < 5; ++i) {
    const std::string whole = picture_message({}, 10 * i, time_of(i));
    const std::string other = image_message({}, sent(grey_picture(1, 16, 12), time_of(i)));
    out.add_message(1, time_of(i), i == 1 ? whole.substr(0, 100) : whole);
    out.add_message(2, time_of(i), i == 3 ? other : picture_message({}, 10 * i + 1, time_of(i)));
  }
  const auto source = open_file(out.finish());
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 2, 4));
  EXPECT_EQ(source->skipped().count, 3);  // the message, what would have been its partner, the other size
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("16x12 px, the others are 32x24"));
}

TEST_F(DamagedMcap, WhatCannotBeReadAtAllIsRefusedInOneLine) {
  const std::string file = five_pairs({}).finish();
  expect_file_refused("", "not an MCAP file");
  expect_file_refused("#ROSBAG V2.0\nand more", "mcap convert");
  expect_file_refused("SQLite format 3 and more", "ros2 bag convert");
  expect_file_refused(file.substr(0, 8), "holds no pictures");
  expect_file_refused(file, "holds no pictures as '/nowhere'; topics of pictures: /stereo/left/image_raw",
                      ",/stereo/left/image_raw,/nowhere");
  expect_file_refused(file, "holds no pictures as '/stereo/left/camera_info'",
                      ",/stereo/left/camera_info,/stereo/left/image_raw");
  expect_file_refused(file, "must be two topics", ",/stereo/left/image_raw,/stereo/left/image_raw");
  expect_file_refused(file, "FILE,LEFT_TOPIC,RIGHT_TOPIC", ",/stereo/left/image_raw");
  expect_file_refused(writer({}).finish(), "no stereo pair");
  EXPECT_THROW((void)open_source({.spec = "mcap:/nowhere.mcap"}), std::runtime_error);
  const auto swapped = open_file(file, ",/stereo/right/image_raw,/stereo/left/image_raw");
  EXPECT_EQ(swapped->next()->left, grey_picture(1));
}

TEST_F(DamagedMcap, AFolderWithOneFileIsThatFile) {
  const std::string file = five_pairs({}).finish();
  folder_.write("bag/metadata.yaml", "");
  const std::string spec = "mcap:" + (folder_.path() / "bag").string();
  const auto refused = [&](const std::string& why) {
    EXPECT_THAT([&] { (void)open_source({.spec = spec}); },
                ::testing::ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  };
  refused("no .mcap file");
  folder_.write("bag/bag_0.mcap", file);
  EXPECT_EQ(times(*open_source({.spec = spec})).size(), 5U);
  EXPECT_EQ(open_source({.spec = spec + ",/stereo/right/image_raw,/stereo/left/image_raw"})->next()->left,
            grey_picture(1));
  folder_.write("bag/bag_1.mcap", file);
  refused("holds 2 .mcap files");
}

}  // namespace
}  // namespace flogmap
