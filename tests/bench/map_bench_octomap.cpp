#include "map_bench_octomap.hpp"

#include <octomap/OcTree.h>

#include <ctime>

#include "mapping/triangulate.hpp"

namespace flogmap {

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

OctomapResult run_octomap(const BenchViews& bench, double cell_size_m, double max_range_m) {
  OctomapResult result;
  octomap::OcTree tree(cell_size_m);
  for (const View& view : bench.views) {
    octomap::Pointcloud cloud;
    const Image<float>& d = view.disparity.px;
    for (int y = 0; y < d.height; ++y) {
      for (int x = 0; x < d.width; ++x) {
        if (!(d.at(x, y) > 0)) continue;
        const Eigen::Vector3f q =
            (view.world_from_camera * triangulate(bench.camera, x, y, d.at(x, y))).cast<float>();
        cloud.push_back(q.x(), q.y(), q.z());
      }
    }
    const Eigen::Vector3f T = view.world_from_camera.translation().cast<float>();
    const double start = cpu_ms();
    tree.insertPointCloud(cloud, octomap::point3d(T.x(), T.y(), T.z()), max_range_m);
    result.ms.push_back(cpu_ms() - start);
  }
  result.bytes = tree.memoryUsage();
  return result;
}

}  // namespace flogmap
