#include "server/views/glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kLinear = 9729, kClampToEdge = 33071;
constexpr std::size_t kMaxShortVertices = 65535;  // the last index means "restart"

void put_u32(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(value >> shift));
}

void put_u16(std::string& out, std::uint16_t value) {
  out.push_back(static_cast<char>(value & 0xff));
  out.push_back(static_cast<char>(value >> 8));
}

void put_float(std::string& out, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u32(out, bits);
}

void pad(std::string& out, char with) { out.resize((out.size() + 3) / 4 * 4, with); }

/// The binary chunk, and what the JSON says of its parts.
struct Binary {
  std::string bytes;
  Json views = Json::array();

  template <typename Fill>
  std::size_t add_part(int target, Fill fill) {
    pad(bytes, '\0');
    const std::size_t offset = bytes.size();
    fill(bytes);
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size() - offset}};
    if (target != 0) view["target"] = target;
    views.push_back(view);
    return views.size() - 1;
  }
};

Json position_accessor(const ViewMesh& mesh, std::size_t view) {
  std::array<float, 3> least = mesh.vertices.front().position_m, most = least;
  for (const ViewMesh::Vertex& vertex : mesh.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min(least[i], vertex.position_m[i]);
      most[i] = std::max(most[i], vertex.position_m[i]);
    }
  }
  return {{"bufferView", view},
          {"componentType", kFloat},
          {"count", mesh.vertices.size()},
          {"type", "VEC3"},
          {"min", least},
          {"max", most}};
}

/// Adds vertices and triangles; returns the accessors for position, texture coordinates and indices.
Json add_geometry(const ViewMesh& mesh, Binary& binary) {
  const bool is_short = mesh.vertices.size() <= kMaxShortVertices;
  const std::size_t positions = binary.add_part(kArrayBuffer, [&](std::string& out) {
    for (const auto& vertex : mesh.vertices) {
      for (const float value : vertex.position_m) put_float(out, value);
    }
  });
  const std::size_t textures = binary.add_part(kArrayBuffer, [&](std::string& out) {
    for (const auto& vertex : mesh.vertices) {
      for (const std::uint16_t value : vertex.texture) put_u16(out, value);
    }
  });
  const std::size_t indices = binary.add_part(kElementArrayBuffer, [&](std::string& out) {
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (is_short) {
          put_u16(out, static_cast<std::uint16_t>(index));
        } else {
          put_u32(out, index);
        }
      }
    }
  });
  return Json::array({position_accessor(mesh, positions),
                      {{"bufferView", textures},
                       {"componentType", kUnsignedShort},
                       {"normalized", true},
                       {"count", mesh.vertices.size()},
                       {"type", "VEC2"}},
                      {{"bufferView", indices},
                       {"componentType", is_short ? kUnsignedShort : kUnsignedInt},
                       {"count", 3 * mesh.triangles.size()},
                       {"type", "SCALAR"}}});
}

/// World (z up) -> pose of the view.
Json nodes_of(const SE3& world_from_camera, const std::string& name, bool has_mesh) {
  const double half = std::sqrt(0.5);
  const Eigen::Vector3d t = world_from_camera.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(world_from_camera.rotation()).normalized();
  Json view = {
      {"name", name}, {"translation", {t.x(), t.y(), t.z()}}, {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
  if (has_mesh) view["mesh"] = 0;
  return Json::array({{{"name", "world, z up"}, {"rotation", {-half, 0, 0, half}}, {"children", {1}}}, view});
}

void describe_mesh(Json& document, const ViewMesh& mesh, const std::string& jpeg, Binary& binary) {
  document["extensionsUsed"] = {"KHR_materials_unlit"};
  document["accessors"] = add_geometry(mesh, binary);
  const std::size_t picture = binary.add_part(0, [&](std::string& out) { out += jpeg; });
  document["meshes"] = Json::array(
      {{{"primitives",
         Json::array(
             {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", 0}}})}}});
  document["materials"] =
      Json::array({{{"pbrMetallicRoughness",
                     {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                    {"extensions", {{"KHR_materials_unlit", Json::object()}}}}});
  document["textures"] = Json::array({{{"sampler", 0}, {"source", 0}}});
  document["images"] = Json::array({{{"bufferView", picture}, {"mimeType", "image/jpeg"}}});
  document["samplers"] = Json::array(
      {{{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}}});
  pad(binary.bytes, '\0');
  document["bufferViews"] = binary.views;
  document["buffers"] = Json::array({{{"byteLength", binary.bytes.size()}}});
}

}  // namespace

std::string glb_of(const ViewMesh& mesh, const std::string& jpeg, const SE3& world_from_camera,
                   const std::string& name) {
  const bool has_mesh = !mesh.triangles.empty();
  Binary binary;
  Json document = {{"asset", {{"version", "2.0"}, {"generator", "flogmap"}}},
                   {"scene", 0},
                   {"scenes", Json::array({{{"nodes", {0}}}})},
                   {"nodes", nodes_of(world_from_camera, name, has_mesh)}};
  if (has_mesh) describe_mesh(document, mesh, jpeg, binary);
  std::string json = document.dump();
  pad(json, ' ');
  std::string out;
  const std::size_t total = 12 + 8 + json.size() + (has_mesh ? 8 + binary.bytes.size() : 0);
  for (const std::uint32_t word : {kMagic, 2U, static_cast<std::uint32_t>(total)}) put_u32(out, word);
  for (const std::uint32_t word : {static_cast<std::uint32_t>(json.size()), kJsonChunk}) put_u32(out, word);
  out += json;
  if (!has_mesh) return out;
  for (const std::uint32_t word : {static_cast<std::uint32_t>(binary.bytes.size()), kBinChunk})
    put_u32(out, word);
  return out + binary.bytes;
}

}  // namespace flogmap
