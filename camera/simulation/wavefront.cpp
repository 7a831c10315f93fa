#include "camera/simulation/wavefront.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

/// "7", "7/1", "7//3", "-1/2": the first number is the vertex, from 1 or back from the end.
int vertex_index(const std::string& corner, int num_vertices) {
  int index = 0;
  std::istringstream(corner.substr(0, corner.find('/'))) >> index;
  index = index < 0 ? num_vertices + index : index - 1;
  if (index < 0 || index >= num_vertices) throw std::runtime_error("no vertex '" + corner + "'");
  return index;
}

void read_face(std::istringstream& line, WavefrontMesh& mesh) {
  std::vector<int> corners;
  for (std::string corner; line >> corner;) {
    corners.push_back(vertex_index(corner, static_cast<int>(mesh.vertices.size())));
  }
  if (corners.size() < 3) throw std::runtime_error("a face needs 3 vertices");
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
}

}  // namespace

WavefrontMesh read_wavefront(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ": cannot be opened");
  WavefrontMesh mesh;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    std::istringstream line(text);
    std::string kind;
    line >> kind;
    try {
      if (kind == "f") read_face(line, mesh);
      if (kind != "v") continue;
      Eigen::Vector3d v;
      if (!(line >> v.x() >> v.y() >> v.z()) || v.cwiseAbs().maxCoeff() > 1e6)
        throw std::runtime_error("bad vertex");
      mesh.vertices.push_back(v);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (mesh.triangles.empty()) throw std::runtime_error(file.string() + ": no faces");
  return mesh;
}

}  // namespace flogmap
