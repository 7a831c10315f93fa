// A view at once, one fan of rays per azimuth: the fast integrator. FLOG.md section 7.
#pragma once

#include <vector>

#include "mapping/flog/fan_rays.hpp"
#include "mapping/flog/ray_model.hpp"
#include "mapping/flog/view_evidence.hpp"

namespace flogmap {

/// Keeps its working memory from view to view; nothing else.
class FanIntegrator {
 public:
  FanIntegrator(const RayModel& model, const GridSpec& grid) : model_(model), grid_(grid) {}

  /// Adds what the rays of the view say about the cells to the sums, each thread to its own: there are as
  /// many threads as sums. All sums together do not depend on how many there are.
  void integrate(const View& view, std::vector<ViewEvidence>& sums);

 private:
  void integrate_bins(const SE3& world_from_camera, int first_bin, int end_bin, ViewEvidence& evidence) const;

  RayModel model_;
  GridSpec grid_;
  FanRays rays_;
};

}  // namespace flogmap
