// Laws of kept views and their meshes: what comes out is the surface that the disparity says, cut at its
// steps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "server/views/glb.hpp"
#include "server/views/view_codec.hpp"
#include "server/views/view_keeper.hpp"
#include "server/views/view_mesh.hpp"
#include "server/views/view_shelf.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const StereoCamera kCamera{300, 159.5, 119.5, 0.1, 320, 240};

View view_of(const Image<float>& disparity, std::int64_t timestamp_ns = 7) {
  View view;
  view.timestamp_ns = timestamp_ns;
  view.world_from_camera.translation() = Eigen::Vector3d(1, -2, 1.5);
  view.disparity.px = disparity;
  view.left = Image<std::uint8_t>(disparity.width, disparity.height, 90);
  return view;
}

/// The floor `height` metres below a level camera, as far as the disparity is at least 1 px.
Image<float> floor_disparity(double height) {
  Image<float> disparity(320, 240, kNaN);
  for (int y = 121; y < 240; ++y) {
    for (int x = 0; x < 320; ++x)
      disparity.at(x, y) = static_cast<float>(kCamera.baseline_m * (y - kCamera.cy_px) / height);
  }
  return disparity;
}

UnpackedView unpacked(const Image<float>& disparity) {
  return unpack_view(pack_view(view_of(disparity), 0)).value();
}

TEST(ViewCodec, GivesTheSampledDisparityBackToAHalfOfA64th) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(-5, 200);
  for (const auto& [width, height] : {std::pair{320, 240}, {641, 479}, {1, 1}}) {
    Image<float> disparity(width, height);
    for (float& d : disparity.pixels) d = value(random) < 0 ? kNaN : value(random);
    for (float& d : disparity.pixels) d = d > 0 ? d : kNaN;
    const UnpackedView out = unpacked(disparity);
    EXPECT_EQ(out.width_px, width);
    EXPECT_EQ(out.disparity_px.width, (width + out.step - 1) / out.step);
    for (int j = 0; j < out.disparity_px.height; ++j) {
      for (int i = 0; i < out.disparity_px.width; ++i) {
        const float in = disparity.at(i * out.step, j * out.step);
        if (std::isnan(in) || in < 1.0F / 128) continue;
        ASSERT_NEAR(out.disparity_px.at(i, j), in, 1.0 / 128 + 1e-5);
      }
    }
  }
}

TEST(ViewCodec, RefusesDamagedBytesInsteadOfReadingBeyondThem) {
  const StoredView good = pack_view(view_of(floor_disparity(1.5)), 3);
  for (const std::size_t size : {std::size_t{0}, std::size_t{15}, std::size_t{16}, std::size_t{200}}) {
    StoredView cut = good;
    cut.bytes.resize(size);
    EXPECT_FALSE(unpack_view(cut).has_value()) << size;
  }
  for (std::size_t at = 0; at < 16; ++at) {
    StoredView wrong = good;
    wrong.bytes[at] ^= 0xff;
    EXPECT_FALSE(unpack_view(wrong).has_value()) << at;
  }
  StoredView other = good;
  other.codec = 99;
  EXPECT_FALSE(unpack_view(other).has_value());
}

TEST(ViewMesh, OfAFloorLiesOnTheFloor) {
  const ViewMesh mesh = mesh_of(unpacked(floor_disparity(1.5)), kCamera);
  ASSERT_GT(mesh.triangles.size(), 1000U);
  for (const auto& vertex : mesh.vertices) {
    const double away = std::abs(vertex.position_m[1] - 1.5);
    EXPECT_LT(away, 1.5 / 64 / 3);  // half a step of the rounding, at the least disparity of 3 px
  }
}

TEST(ViewMesh, TrianglesFaceTheCamera) {
  const ViewMesh mesh = mesh_of(unpacked(floor_disparity(1.0)), kCamera);
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto point = [&](std::uint32_t i) {
      const auto& p = mesh.vertices[i].position_m;
      return Eigen::Vector3f(p[0], p[1], p[2]);
    };
    const Eigen::Vector3f normal = (point(b) - point(a)).cross(point(c) - point(a));
    EXPECT_LT(normal.dot(point(a)), 0) << "the normal of a front face looks back at the camera";
  }
}

TEST(ViewMesh, IsCutWhereTheDepthSteps) {
  Image<float> disparity(320, 240, 10.0F);  // a wall at 3 m, and a box in front of it at 1.5 m
  for (int y = 80; y < 160; ++y) {
    for (int x = 100; x < 200; ++x) disparity.at(x, y) = 20.0F;
  }
  const ViewMesh mesh = mesh_of(unpacked(disparity), kCamera);
  bool near = false, far = false;
  for (const auto& triangle : mesh.triangles) {
    float least = 1e9F, most = 0;
    for (const std::uint32_t i : triangle) {
      least = std::min(least, mesh.vertices[i].position_m[2]);
      most = std::max(most, mesh.vertices[i].position_m[2]);
    }
    EXPECT_LT(most - least, 0.1F);
    near = near || most < 2;
    far = far || least > 2;
  }
  EXPECT_TRUE(near && far);
}

TEST(ViewMesh, FillsNoHoleAndKeepsNothingFar) {
  Image<float> disparity(320, 240, 10.0F);
  for (int y = 100; y < 140; ++y) {
    for (int x = 100; x < 140; ++x) disparity.at(x, y) = kNaN;
  }
  for (int y = 0; y < 240; ++y) {
    for (int x = 260; x < 320; ++x) disparity.at(x, y) = 2.0F;
  }
  for (const auto& vertex : mesh_of(unpacked(disparity), kCamera).vertices) {
    const double x = kCamera.cx_px + kCamera.focal_px * vertex.position_m[0] / vertex.position_m[2];
    const double y = kCamera.cy_px + kCamera.focal_px * vertex.position_m[1] / vertex.position_m[2];
    EXPECT_FALSE(x > 102 && x < 137 && y > 102 && y < 137) << "in the hole";
    EXPECT_LT(vertex.position_m[2], 10.1F);
  }
}

/// The chunks of a GLB, read by the specification and not by our writer.
struct ReadGlb {
  json document;
  std::string binary;
};

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

ReadGlb read(const std::string& glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word(glb, 4), 2U);
  EXPECT_EQ(word(glb, 8), glb.size());
  ReadGlb read;
  for (std::size_t at = 12; at < glb.size(); at += 8 + word(glb, at)) {
    EXPECT_EQ(word(glb, at) % 4, 0U);
    const std::string chunk = glb.substr(at + 8, word(glb, at));
    if (glb.substr(at + 4, 4) == "JSON") read.document = json::parse(chunk);
    if (glb.substr(at + 4, 4) == std::string("BIN\0", 4)) read.binary = chunk;
  }
  return read;
}

TEST(Glb, HoldsTheMeshThePictureAndThePose) {
  const View view = view_of(floor_disparity(1.5));
  const UnpackedView packed = unpack_view(pack_view(view, 0)).value();
  const ViewMesh mesh = mesh_of(packed, kCamera);
  const ReadGlb glb = read(glb_of(mesh, packed.jpeg, view.world_from_camera, "view 0"));
  const json& document = glb.document;
  EXPECT_EQ(document["asset"]["version"], "2.0");
  EXPECT_EQ(document["buffers"][0]["byteLength"], glb.binary.size());
  for (const json& part : document["bufferViews"]) {
    EXPECT_EQ(part["byteOffset"].get<std::size_t>() % 4, 0U);
    EXPECT_LE(part["byteOffset"].get<std::size_t>() + part["byteLength"].get<std::size_t>(),
              glb.binary.size());
  }
  const json& positions = document["accessors"][0];
  ASSERT_EQ(positions["count"], mesh.vertices.size());
  const std::size_t start = document["bufferViews"][positions["bufferView"].get<std::size_t>()]["byteOffset"];
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), glb.binary.data() + start + i * sizeof p, sizeof p);
    ASSERT_EQ(p, mesh.vertices[i].position_m);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(p[k], positions["min"][k].get<float>());
      ASSERT_LE(p[k], positions["max"][k].get<float>());
    }
  }
  const json& picture = document["bufferViews"][document["images"][0]["bufferView"].get<std::size_t>()];
  EXPECT_EQ(glb.binary.substr(picture["byteOffset"], picture["byteLength"]), packed.jpeg);
  EXPECT_EQ(document["nodes"][1]["translation"], json({1.0, -2.0, 1.5}));
}

TEST(Glb, OfNothingIsASceneWithoutAMesh) {
  const ReadGlb glb = read(glb_of({}, "", SE3::Identity(), "nothing"));
  EXPECT_EQ(glb.document["scenes"].size(), 1U);
  EXPECT_FALSE(glb.document.contains("meshes"));
  EXPECT_TRUE(glb.binary.empty());
}

TEST(ViewKeeper, KeepsAPlaceOnceInEachDirection) {
  ViewKeeper keeper;
  View view = view_of(Image<float>(8, 8, 5.0F));
  int kept = 0;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 36; ++i) {  // round a circle of 1 m, looking along it
      const double angle = 2 * std::numbers::pi * i / 36;
      view.world_from_camera = Eigen::Translation3d(std::cos(angle), std::sin(angle), 1) *
                               Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
      kept += keeper.keep(view) ? 1 : 0;
    }
    EXPECT_EQ(kept, 36) << "the second and third round show nothing new";
  }
}

TEST(ViewKeeper, NumbersGoOnAfterThoseOfAContinuedMap) {
  ViewKeeper keeper;
  auto old = std::make_shared<StoredView>();
  old->number = 41;
  old->world_from_camera.translation() = Eigen::Vector3d(9, 9, 9);
  keeper.begin({old});
  EXPECT_EQ(keeper.keep(view_of(Image<float>(8, 8, 5.0F)))->number, 42);
}

TEST(ViewShelf, StaysWithinItsBudgetAndCoversAllOfThePath) {
  ViewShelf shelf(10'000);
  for (std::int64_t n = 0; n < 1000; ++n) {
    shelf.add(std::make_shared<const StoredView>(
        StoredView{n, n, SE3::Identity(), 2, std::vector<std::uint8_t>(100)}));
    ASSERT_LE(shelf.bytes(), 10'000U);
  }
  EXPECT_NE(shelf.find(0), nullptr);
  std::int64_t before = 0;
  for (const auto& [number, view] : shelf.all()) {
    EXPECT_LE(number - before, 1000 / 8);
    before = number;
  }
}

TEST(ViewShelf, PosesFollowThePath) {
  std::map<std::int64_t, SharedView> views;
  for (std::int64_t n = 0; n < 3; ++n)
    views[n] = std::make_shared<const StoredView>(StoredView{n, 10 * n, SE3::Identity(), 2, {}});
  TrajectoryEntry corrected;
  corrected.timestamp_ns = 10;
  corrected.world_from_camera.translation() = Eigen::Vector3d(0.5, 0, 0);
  const std::vector<SE3> poses = poses_on_path(views, std::vector{corrected});
  EXPECT_EQ(poses[0].translation().x(), 0);
  EXPECT_EQ(poses[1].translation().x(), 0.5);
  EXPECT_EQ(poses[2].translation().x(), 0);
}

}  // namespace
}  // namespace flogmap
