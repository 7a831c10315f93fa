// The samples of tests/golden/wire, which the page's tests read too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "flogmap/v1/stream.pb.h"
#include "server/client_message.hpp"
#include "server/tile_planes.hpp"
#include "tests/server/wire_samples.hpp"

namespace flogmap {
namespace {

std::string file(const std::string& name) {
  std::ifstream stream(FLOGMAP_SOURCE_DIR "/tests/golden/wire/" + name, std::ios::binary);
  EXPECT_TRUE(stream) << name << " is missing; see tests/golden/wire/README.md";
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<WireSample> all_samples() {
  auto samples = server_samples();
  for (const WireSample& sample : client_samples()) samples.push_back(sample);
  return samples;
}

std::string inflated(const std::string& deflated, std::size_t size) {
  const PlaneBytes planes = inflate_planes(deflated, size);
  return {planes.begin(), planes.end()};
}

TEST(WireGolden, FilesSayWhatTheirJsonSays) {
  for (const WireSample& sample : all_samples()) {
    const WireSample kept{sample.name, file(sample.name + ".bin"), sample.has_tiles};
    EXPECT_EQ(nlohmann::json::parse(to_json(kept)), nlohmann::json::parse(file(sample.name + ".json")))
        << sample.name;
  }
}

TEST(WireGolden, TodaysEncoderWritesTheSameBytes) {
  for (const WireSample& sample : all_samples()) {
    if (sample.has_tiles) continue;
    EXPECT_EQ(sample.bytes, file(sample.name + ".bin")) << sample.name;
  }
}

TEST(WireGolden, TilesInflateToTheStatedPlanes) {
  v1::ServerMessage evidence, value;
  ASSERT_TRUE(evidence.ParseFromString(file("server_tile_batch_evidence.bin")));
  ASSERT_TRUE(value.ParseFromString(file("server_tile_batch_value.bin")));
  for (int layer = 0; layer < 2; ++layer) {
    const auto& planes = evidence.tile_batch().tiles(0).layers(layer);
    EXPECT_EQ(inflated(planes.evidence(), 3 * kTileColumns), sample_evidence(layer));
    EXPECT_EQ(inflated(value.tile_batch().tiles(0).layers(layer).value(), kTileColumns), sample_value(layer));
  }
  EXPECT_EQ(inflated(evidence.tile_batch().tiles(0).layers(0).change(), kTileColumns), sample_change());
  EXPECT_TRUE(evidence.tile_batch().tiles(0).layers(1).change().empty());
}

TEST(WireGolden, TodaysTilesMeanTheSame) {
  for (const WireSample& sample : server_samples()) {
    if (!sample.has_tiles) continue;
    v1::ServerMessage today, kept;
    ASSERT_TRUE(today.ParseFromString(sample.bytes));
    ASSERT_TRUE(kept.ParseFromString(file(sample.name + ".bin")));
    for (auto* message : {&today, &kept}) {
      for (auto& tile : *message->mutable_tile_batch()->mutable_tiles()) {
        for (auto& layer : *tile.mutable_layers()) {
          if (layer.has_value()) layer.set_value(inflated(layer.value(), kTileColumns));
          if (layer.has_evidence()) layer.set_evidence(inflated(layer.evidence(), 3 * kTileColumns));
          layer.set_change(inflated(layer.change(), layer.change().empty() ? 0 : kTileColumns));
        }
      }
    }
    EXPECT_EQ(today.SerializeAsString(), kept.SerializeAsString()) << sample.name;
  }
}

TEST(WireGolden, ClientMessagesAreUnderstood) {
  const auto decoded = [](const std::string& name) {
    return decode_client_message(file("client_" + name + ".bin"));
  };
  const auto hello = std::get<Hello>(decoded("hello").value());
  EXPECT_EQ(hello.versions, std::vector<std::uint32_t>{1});
  EXPECT_EQ(hello.resume.value().epoch, "0123456789abcdef");
  EXPECT_EQ(hello.resume.value().revision, 4711U);
  EXPECT_EQ(hello.resume.value().trajectory_length, 2U);
  const auto subscribe = std::get<Subscribe>(decoded("subscribe").value());
  EXPECT_EQ(subscribe.tiles, (TileChoice{{0, 2}, Planes::evidence}));
  ASSERT_EQ(subscribe.images.size(), 1U);
  EXPECT_EQ(subscribe.images[0].stream, ImageStream::disparity);
  EXPECT_EQ(subscribe.images[0].max_fps, 7.5);
  EXPECT_EQ(subscribe.images[0].max_width_px, 320);
  EXPECT_EQ(subscribe.pose_hz, 20);
  EXPECT_TRUE(subscribe.features);
  EXPECT_EQ(std::get<Viewport>(decoded("viewport").value()), (Viewport{{-1.5, -2.5, 3.5, 4.5}, 1}));
  EXPECT_EQ(std::get<Ack>(decoded("ack").value()).bytes, 262'144U);
  EXPECT_EQ(std::get<Forget>(decoded("forget").value()).keys, (std::vector<TileKey>{{1, -4, 9}}));
  EXPECT_EQ(std::get<InspectCell>(decoded("inspect_cell").value()).y_m, -2.03);
  EXPECT_EQ(std::get<Ping>(decoded("ping").value()).nonce, 77U);
}

TEST(ClientMessages, TextThatIsNoUtf8IsRefusedWithoutALineInTheLog) {
  const std::string hello("\x0a\x09\x0a\x01\x01\x12\x04\x0a\x02\xff\xfe", 11);  // its epoch is ff fe
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(decode_client_message(hello));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace flogmap
