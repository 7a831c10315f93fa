#include "camera/simulation/lighting.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <thread>

#include "camera/picture_files.hpp"
#include "camera/simulation/face_tree.hpp"
#include "camera/simulation/noise.hpp"
#include "camera/simulation/patterns.hpp"

namespace flogmap {
namespace {

using Eigen::Vector3d;

constexpr double kLightGridM = 0.08;  // wider on faces beyond 10 m
constexpr double kLightGridPoints = 128;
constexpr int kMaxTexels = 4096;
constexpr int kSkyRays = 16;
constexpr double kCornerLight = 0.35;  // of the ambient light reaches the deepest corner
constexpr double kSkyReachM = 0.9;     // what is further away does not darken a corner
constexpr double kLampRadiusM = 0.15;  // soft shadows
constexpr int kLampRays = 6;

/// The i-th of n directions around the normal, denser towards it (cosine law), turned by a random angle.
Vector3d sky_direction(const Face& face, int i, double turn) {
  const double sine = std::sqrt((i + 0.5) / kSkyRays);
  const double angle = 2.39996323 * i + 2 * std::numbers::pi * turn;  // the golden angle
  return face.u_axis * (sine * std::cos(angle)) + face.v_axis * (sine * std::sin(angle)) +
         face.normal * std::sqrt(1 - sine * sine);
}

/// The share of directions in which nothing near is in the way.
double open_share(const FaceTree& tree, const Face& face, const Vector3d& point, double turn) {
  int open = 0;
  for (int i = 0; i < kSkyRays; ++i)
    open += tree.blocked(point, sky_direction(face, i, turn), kSkyReachM) ? 0 : 1;
  return static_cast<double>(open) / kSkyRays;
}

double from_lamp(const FaceTree& tree, const Face& face, const Vector3d& point, const Lamp& lamp,
                 double turn) {
  double sum = 0;
  for (int i = 0; i < kLampRays; ++i) {
    const double angle = 2 * std::numbers::pi * (i + turn) / kLampRays;
    const Vector3d at = lamp.position_m +
                        kLampRadiusM * Vector3d(std::cos(angle), std::sin(angle), 0.5 * std::cos(2 * angle));
    const double distance = (at - point).norm();
    const Vector3d direction = (at - point) / distance;
    const double facing = face.normal.dot(direction);
    if (facing <= 0 || tree.blocked(point, direction, distance - 0.01)) continue;
    sum += lamp.power * facing / (distance * distance);
  }
  return sum / kLampRays;
}

/// Light on a grid of points of the face, coarse because light is smooth; empty if the face is hidden
/// everywhere, as where two boxes touch.
Image<float> light_map(const Scene& scene, const FaceTree& tree, const Face& face) {
  if (scene.materials[face.material].glows) return Image<float>(2, 2, 1.0F);
  const double grid_m = std::max(kLightGridM, face.extent_m.maxCoeff() / kLightGridPoints);
  const Eigen::Vector2i size = (face.extent_m / grid_m).array().ceil().cast<int>() + 1;
  Image<float> map(size.x(), size.y());
  double most_open = 0;
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const double u = std::clamp(face.extent_m.x() * i / (map.width - 1), 0.003, face.extent_m.x() - 0.003);
      const double v = std::clamp(face.extent_m.y() * j / (map.height - 1), 0.003, face.extent_m.y() - 0.003);
      const Vector3d point = face.origin_m + u * face.u_axis + v * face.v_axis + 0.002 * face.normal;
      const double turn = cell_noise(i, j, static_cast<std::uint32_t>(face.pattern_seed));
      const double openness = open_share(tree, face, point, turn);
      most_open = std::max(most_open, openness);
      double light = scene.lighting.ambient * (kCornerLight + (1 - kCornerLight) * openness);
      for (const Lamp& lamp : scene.lighting.lamps) light += from_lamp(tree, face, point, lamp, turn);
      map.at(i, j) = static_cast<float>(light);
    }
  }
  if (most_open == 0) return {};
  const cv::Mat view(map.height, map.width, CV_32F, map.pixels.data());
  if (std::min(map.width, map.height) > 2) cv::GaussianBlur(view, view, {3, 3}, 0);  // the rays' randomness
  return map;
}

double sample(const Image<float>& map, double x, double y) {
  const int x0 = std::clamp(static_cast<int>(x), 0, map.width - 2),
            y0 = std::clamp(static_cast<int>(y), 0, map.height - 2);
  const double tx = std::clamp(x - x0, 0.0, 1.0), ty = std::clamp(y - y0, 0.0, 1.0);
  return (map.at(x0, y0) * (1 - tx) + map.at(x0 + 1, y0) * tx) * (1 - ty) +
         (map.at(x0, y0 + 1) * (1 - tx) + map.at(x0 + 1, y0 + 1) * tx) * ty;
}

/// Bright tones bend towards white instead of being cut off.
std::uint8_t grey_from_light(double light) {
  const double bent = light < 0.7 ? light : 0.7 + 0.3 * (1 - std::exp(-(light - 0.7) / 0.3));
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(bent, 0.0, 1.0)));
}

/// The picture of a material in grey; empty if it has none.
Image<float> material_picture(const Material& material) {
  if (material.image_file.empty()) return {};
  const ReadPicture read = read_picture(material.image_file);
  if (!read.problem.empty()) throw std::runtime_error("material image: " + read.problem);
  const Picture& p = read.picture;
  cv::Mat image(p.height, p.width, CV_MAKETYPE(p.bits == 16 ? CV_16U : CV_8U, p.channels),
                const_cast<std::uint8_t*>(p.bytes.data()));  // only read
  if (p.channels == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  Image<float> grey(p.width, p.height);
  cv::Mat target(p.height, p.width, CV_32F, grey.pixels.data());
  image.convertTo(target, CV_32F, p.bits == 16 ? 1.0 / 65535 : 1.0 / 255);
  return grey;
}

/// What colours one face: its pattern or its picture.
class Paint {
 public:
  Paint(const Material& material, const Face& face)
      : material_(material), pattern_(find_pattern(material.pattern)), picture_(material_picture(material)) {
    point_.width = face.extent_m.x();
    point_.height = face.extent_m.y();
    point_.size = material.size_m;
    point_.seed = mixed(static_cast<std::uint32_t>(face.pattern_seed), 17, 4);
    u_offset_m_ = face.u_offset_m;
  }

  [[nodiscard]] double reflectance(double u, double v) {
    double tone = 0;
    if (picture_.empty()) {
      point_.u = u + u_offset_m_;
      point_.v = v;
      tone = pattern_(point_);
    } else {
      tone = sample(picture_, u / point_.width * picture_.width - 0.5,
                    (1 - v / point_.height) * picture_.height - 0.5);
    }
    return material_.dark + (material_.bright - material_.dark) * tone;
  }

 private:
  Material material_;
  Pattern pattern_;
  Image<float> picture_;
  PatternPoint point_;
  double u_offset_m_ = 0;
};

MipTexture paint_face(const Scene& scene, const FaceTree& tree, const Face& face) {
  const double texel = texel_size_m(scene, face);
  const Eigen::Vector2i size = (face.extent_m / texel).array().ceil().cast<int>().max(2);
  const Image<float> light = light_map(scene, tree, face);
  if (light.empty()) return MipTexture(Image<std::uint8_t>(2, 2));
  const double u_scale = (light.width - 1) / face.extent_m.x(),
               v_scale = (light.height - 1) / face.extent_m.y();
  Paint paint(scene.materials[face.material], face);
  Image<std::uint8_t> picture(size.x(), size.y());
  for (int j = 0; j < picture.height; ++j) {
    const double v = (j + 0.5) * texel;
    for (int i = 0; i < picture.width; ++i) {
      const double u = (i + 0.5) * texel;
      picture.at(i, j) = grey_from_light(paint.reflectance(u, v) * sample(light, u * u_scale, v * v_scale));
    }
  }
  return MipTexture(picture);
}

}  // namespace

double texel_size_m(const Scene& scene, const Face& face) {
  const double wanted = scene.materials[face.material].texel_m;
  return std::max(wanted > 0 ? wanted : scene.texel_m, face.extent_m.maxCoeff() / kMaxTexels);
}

std::vector<MipTexture> paint_faces(const Scene& scene, const std::vector<Face>& faces) {
  const FaceTree tree(faces);
  std::vector<MipTexture> textures(faces.size());
  std::atomic<std::size_t> next = 0;
  std::exception_ptr problem;
  std::mutex problem_mutex;
  const auto paint = [&] {
    try {
      for (std::size_t i = next++; i < faces.size(); i = next++)
        textures[i] = paint_face(scene, tree, faces[i]);
    } catch (...) {
      const std::lock_guard lock(problem_mutex);
      problem = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> painters(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
    for (std::jthread& painter : painters) painter = std::jthread(paint);
  }
  if (problem) std::rethrow_exception(problem);
  return textures;
}

}  // namespace flogmap
