#include "camera/simulation/scene_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "camera/simulation/built_in_scenes.hpp"
#include "camera/simulation/json_fields.hpp"
#include "camera/simulation/patterns.hpp"
#include "camera/simulation/wavefront.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using MaterialIndex = std::map<std::string, std::size_t>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kForever = 1e18;

void read_camera(JsonFields fields, Scene& scene) {
  StereoCamera& camera = scene.camera;
  camera.width_px = fields.whole("width_px", camera.width_px, 16, 8192);
  camera.height_px = fields.whole("height_px", camera.height_px, 16, 8192);
  camera.focal_px = fields.number("focal_px", camera.focal_px, 1, 1e5);
  camera.cx_px = fields.number("cx_px", (camera.width_px - 1) / 2.0, -1e5, 1e5);
  camera.cy_px = fields.number("cy_px", (camera.height_px - 1) / 2.0, -1e5, 1e5);
  camera.baseline_m = fields.number("baseline_m", camera.baseline_m, 1e-4, 100);
  scene.rate_hz = fields.number("rate_hz", scene.rate_hz, 0.01, 1000);
  fields.done();
}

void read_materials(JsonFields& root, const std::string& folder, Scene& scene, MaterialIndex& index) {
  JsonFields fields = root.object("materials");
  for (const auto& [name, value] : root.required("materials").items()) {
    JsonFields entry = fields.object(name);
    Material material;
    material.pattern = entry.text("pattern", material.pattern);
    try {
      static_cast<void>(find_pattern(material.pattern));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(entry.place() + "." + error.what());
    }
    if (entry.has("image")) material.image_file = (fs::path(folder) / entry.text("image", "")).string();
    material.size_m = entry.number("size_m", material.size_m, 0.001, 1000);
    material.dark = entry.number("dark", material.dark, 0, 1);
    material.bright = entry.number("bright", material.bright, 0, 1);
    material.glows = entry.flag("glows", false);
    material.texel_m = entry.number("texel_m", 0, 2e-4, 1);
    entry.done();
    index[name] = scene.materials.size();
    scene.materials.push_back(std::move(material));
  }
}

std::size_t material_of(JsonFields& fields, const std::string& key, const MaterialIndex& index,
                        std::size_t otherwise) {
  if (!fields.has(key)) return otherwise;
  const auto found = index.find(fields.text(key, ""));
  if (found != index.end()) return found->second;
  std::string allowed;
  for (const auto& entry : index) allowed += (allowed.empty() ? "" : ", ") + entry.first;
  fields.fail(key, "one of the materials " + allowed);
}

/// A box or hall by two opposite corners, or by its middle on the ground and its size.
void read_box(JsonFields fields, Solid& solid) {
  if (fields.has("min")) {
    const Vector3d low = fields.vector("min"), high = fields.vector("max");
    solid.size_m = high - low;
    solid.world_from_solid.translation() = (low + high) / 2;
  } else {
    solid.size_m = fields.vector("size_m");
    solid.world_from_solid.translation() = fields.vector("at") + Vector3d(0, 0, solid.size_m.z() / 2);
  }
  if (solid.size_m.minCoeff() <= 0)
    throw std::runtime_error(fields.place() + " must have a size > 0 in x, y and z");
  const double yaw = fields.number("yaw_deg", 0, -360, 360) * kDegree;
  solid.world_from_solid.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  fields.done();
}

void read_cylinder(JsonFields fields, Solid& solid) {
  const double radius = fields.number("radius_m", 0.1, 1e-3, 1000);
  const double height = fields.number("height_m", 1, 1e-3, 1000);
  solid.kind = SolidKind::cylinder;
  solid.size_m = {2 * radius, 2 * radius, height};
  solid.facets = fields.whole("facets", 48, 3, 512);
  solid.world_from_solid.translation() = fields.vector("at") + Vector3d(0, 0, height / 2);
  const Vector3d axis = fields.vector("axis", Vector3d::UnitZ());
  if (axis.norm() < 1e-9) fields.fail("axis", "a direction");
  solid.world_from_solid.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis));
  fields.done();
}

/// A plane is a board, a millimetre thick behind its front.
void read_plane(JsonFields fields, Solid& solid) {
  constexpr double kThick_m = 0.001;
  const std::vector<double> size_m = fields.numbers("size_m", 2);
  if (!(size_m[0] > 0 && size_m[1] > 0)) fields.fail("size_m", "[width, height] above 0");
  const Vector3d facing = fields.vector("facing").normalized();
  if (!(facing.norm() > 0.5)) fields.fail("facing", "a direction");
  const bool flat = std::abs(facing.z()) > 1 - 1e-9;
  const Vector3d x = flat ? Vector3d::UnitX() : Vector3d(facing.cross(Vector3d::UnitZ()).normalized());
  solid.size_m = {size_m[0], kThick_m, size_m[1]};
  solid.world_from_solid.linear() << x, facing, x.cross(facing);
  solid.world_from_solid.translation() = fields.vector("at") - kThick_m / 2 * facing;
  fields.done();
}

void read_mesh(JsonFields fields, const std::string& folder, Solid& solid) {
  solid.kind = SolidKind::mesh;
  const double scale = fields.number("scale", 1, 1e-6, 1e6);
  WavefrontMesh mesh = read_wavefront(fs::path(folder) / fields.text("file", ""));
  for (Vector3d& vertex : mesh.vertices) vertex *= scale;
  solid.vertices_m = std::move(mesh.vertices);
  solid.triangles = std::move(mesh.triangles);
  solid.world_from_solid.translation() = fields.vector("at", Vector3d::Zero());
  const double yaw = fields.number("yaw_deg", 0, -360, 360) * kDegree;
  solid.world_from_solid.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  fields.done();
}

void read_motion(JsonFields& fields, Solid& solid) {
  solid.from_s = fields.number("from_s", 0, 0, kForever);
  solid.until_s = fields.number("until_s", kForever, 0, kForever);
  for (JsonFields& key : fields.objects("motion")) {
    const double time_s = key.number("time_s", 0, 0, kForever);
    if (!solid.motion.empty() && time_s <= solid.motion.back().time_s)
      key.fail("time_s", "later than the one before");
    solid.motion.push_back({time_s, key.vector("shift")});
    key.done();
  }
}

Solid read_solid(JsonFields fields, const MaterialIndex& materials, const std::string& folder) {
  Solid solid;
  if (fields.has("box")) {
    read_box(fields.object("box"), solid);
  } else if (fields.has("hall")) {
    solid.kind = SolidKind::hall;
    read_box(fields.object("hall"), solid);
  } else if (fields.has("cylinder")) {
    read_cylinder(fields.object("cylinder"), solid);
  } else if (fields.has("plane")) {
    read_plane(fields.object("plane"), solid);
  } else if (fields.has("mesh")) {
    read_mesh(fields.object("mesh"), folder, solid);
  } else {
    throw std::runtime_error(fields.place() + " must have one of box, hall, cylinder, plane, mesh");
  }
  solid.side = material_of(fields, "material", materials, 0);
  solid.top = material_of(fields, "top", materials, solid.side);
  solid.bottom = material_of(fields, "bottom", materials, solid.side);
  read_motion(fields, solid);
  fields.done();
  return solid;
}

void read_lighting(JsonFields fields, Lighting& lighting) {
  lighting.ambient = fields.number("ambient", lighting.ambient, 0, 10);
  for (JsonFields& lamp : fields.objects("lamps")) {
    lighting.lamps.push_back({lamp.vector("at"), lamp.number("power", 1, 0, 1e6)});
    lamp.done();
  }
  fields.done();
}

void read_path(JsonFields fields, Path& path) {
  path.closed = fields.flag("closed", path.closed);
  path.steps = fields.flag("steps", path.steps);
  path.speed_m_s = fields.number("speed_m_s", path.speed_m_s, 1e-3, 100);
  path.tremor_m = fields.number("tremor_m", 0, 0, 1);
  path.tremor_rad = fields.number("tremor_deg", 0, 0, 45) * kDegree;
  for (JsonFields& point : fields.objects("points")) {
    PathPoint read{point.vector("at"), point.vector("look_at"),
                   point.number("roll_deg", 0, -180, 180) * kDegree};
    if ((read.look_at_m - read.position_m).norm() < 1e-6) point.fail("look_at", "different from at");
    path.points.push_back(read);
    point.done();
  }
  if (path.points.empty()) fields.fail("points", "a list with at least one point");
  fields.done();
}

void read_sensor(JsonFields fields, Sensor& sensor) {
  sensor.noise_grey = fields.number("noise_grey", 0, 0, 100);
  sensor.blur_px = fields.number("blur_px", 0, 0, 20);
  sensor.right_gain = fields.number("right_gain", 1, 0.1, 10);
  sensor.drop_probability = fields.number("drop_probability", 0, 0, 0.99);
  sensor.skew_s = fields.number("skew_ms", 0, -1000, 1000) / 1000;
  fields.done();
}

void read_truth(JsonFields fields, Truth& truth) {
  truth.cell_m = fields.number("cell_m", truth.cell_m, 1e-3, 10);
  if (fields.has("layers_m")) truth.layer_bounds_m = fields.numbers("layers_m");
  const std::vector<double>& bounds = truth.layer_bounds_m;
  if (bounds.size() < 2 ||
      std::adjacent_find(bounds.begin(), bounds.end(), std::greater_equal<>()) != bounds.end()) {
    fields.fail("layers_m", "at least two rising heights");
  }
  const std::vector<double> low = fields.numbers("min", 2), high = fields.numbers("max", 2);
  truth.min_m = {low[0], low[1]};
  truth.max_m = {high[0], high[1]};
  const Eigen::Array2d cells = (truth.max_m - truth.min_m).array() / truth.cell_m;
  if (!(cells > 0).all() || !(cells < 1e4).all()) fields.fail("max", "beyond min by at most 10000 cells");
  fields.done();
}

}  // namespace

Scene parse_scene(const std::string& json, const std::string& origin, const std::string& folder) {
  nlohmann::json root;
  try {
    root = nlohmann::json::parse(json, nullptr, true, true);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(origin + ": not valid JSON: " + error.what());
  }
  JsonFields fields(root, origin + ": scene");
  Scene scene;
  scene.name = fields.text("name", fs::path(origin).stem().string());
  scene.texel_m = fields.number("texel_m", scene.texel_m, 2e-4, 1);
  scene.num_frames = fields.whole("num_frames", 0, 0, 1'000'000);
  if (fields.has("camera")) read_camera(fields.object("camera"), scene);
  MaterialIndex materials;
  read_materials(fields, folder, scene, materials);
  if (scene.materials.empty()) fields.fail("materials", "an object with at least one material");
  for (JsonFields& solid : fields.objects("solids"))
    scene.solids.push_back(read_solid(solid, materials, folder));
  if (scene.solids.empty()) fields.fail("solids", "a list with at least one solid");
  if (fields.has("light")) read_lighting(fields.object("light"), scene.lighting);
  read_path(fields.object("path"), scene.path);
  if (fields.has("sensor")) read_sensor(fields.object("sensor"), scene.sensor);
  if (fields.has("truth")) read_truth(fields.object("truth"), scene.truth);
  static_cast<void>(fields.has("about"));  // a remark for readers
  fields.done();
  return scene;
}

std::vector<std::string> built_in_scenes() {
  std::vector<std::string> names;
  for (const BuiltInScene& scene : kBuiltInScenes) names.emplace_back(scene.name);
  return names;
}

Scene load_scene(const std::string& name_or_file) {
  std::string names;
  for (const BuiltInScene& scene : kBuiltInScenes) {
    if (name_or_file == scene.name) return parse_scene(std::string(scene.json), name_or_file, ".");
    names += std::string(scene.name) + ", ";
  }
  std::ifstream in(name_or_file);
  if (!in || !fs::is_regular_file(name_or_file)) {
    throw std::runtime_error("scene must be one of " + names + "or a JSON file, got '" + name_or_file + "'");
  }
  std::ostringstream text;
  text << in.rdbuf();
  return parse_scene(text.str(), name_or_file, fs::path(name_or_file).parent_path().string());
}

}  // namespace flogmap
