// A simulated world as data. docs/scene-format.md describes the JSON form field by field.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"

namespace flogmap {

/// How a surface looks: a procedural pattern or a picture, mapped to reflectances from `dark` to `bright`.
struct Material {
  std::string pattern = "plaster";
  std::string image_file;  // if set, replaces the pattern; stretched over the face
  double size_m = 0.2;     // of the pattern's unit: a plank's width, a brick's length, a tile's side
  double dark = 0.2;       // reflectance [0, 1] of the pattern's darkest tone
  double bright = 0.8;
  double texel_m = 0;  // size of its texels; 0: the scene's
  bool glows = false;  // shows its own tones whatever the light, as the sky does
};

enum class SolidKind { box, cylinder, mesh, hall };  // a hall is a box seen from inside

/// A time at which a solid stands somewhere; between two keys it moves in a straight line.
struct MotionKey {
  double time_s = 0;
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  // from where the scene puts it
};

/// A thing in the world. Metres; z is up.
struct Solid {
  SolidKind kind = SolidKind::box;
  Eigen::Isometry3d world_from_solid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();  // box, hall: edges; cylinder: diameter, -, height
  int facets = 48;                                   // of a cylinder, which is a prism in every respect
  std::vector<Eigen::Vector3d> vertices_m;           // of a mesh, in the solid's frame
  std::vector<Eigen::Vector3i> triangles;            // of a mesh, anticlockwise from outside
  std::size_t side = 0, top = 0, bottom = 0;         // indices into Scene::materials
  double from_s = 0, until_s = 1e18;                 // when it is there at all
  std::vector<MotionKey> motion;
};

/// A point lamp; `power` is the irradiance it gives at one metre.
struct Lamp {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double power = 1;
};

struct Lighting {
  double ambient = 0.5;  // irradiance from everywhere, dimmed in corners
  std::vector<Lamp> lamps;
};

struct PathPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d look_at_m = Eigen::Vector3d::UnitX();
  double roll_rad = 0;
};

/// Where the camera goes: a smooth curve through points at constant speed, or from point to point in steps.
struct Path {
  std::vector<PathPoint> points;
  bool closed = true;  // walks on without end
  bool steps = false;  // stands at every point for one frame instead of walking
  double speed_m_s = 0.4;
  double tremor_m = 0;  // root mean square of a hand's unsteadiness per axis
  double tremor_rad = 0;
};

/// What the sensor does to the picture, and the driver to the stream.
struct Sensor {
  double noise_grey = 0;        // standard deviation
  double blur_px = 0;           // standard deviation of the lens' blur
  double right_gain = 1;        // of the right picture against the left
  double drop_probability = 0;  // of a pair
  double skew_s = 0;            // the right picture is taken this much later
};

/// The layers for which true occupancy is written.
struct Truth {
  double cell_m = 0.02;
  std::vector<double> layer_bounds_m{0.05, 0.75, 1.45, 2.15};
  Eigen::Vector2d min_m{-1, -1}, max_m{1, 1};
};

struct Scene {
  std::string name;
  StereoCamera camera{420, 319.5, 239.5, 0.12, 640, 480};
  double rate_hz = 15;
  double texel_m = 0.003;
  std::vector<Material> materials;
  std::vector<Solid> solids;
  Lighting lighting;
  Path path;
  Sensor sensor;
  Truth truth;
  std::int64_t num_frames = 0;  // of a recording; 0: one round of the path
};

}  // namespace flogmap
