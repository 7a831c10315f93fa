// A view, ray by ray and cell by cell: the reference that the fan is compared with. FLOG.md sections 2 and 6.
#pragma once

#include "mapping/flog/ray_model.hpp"
#include "mapping/flog/view_evidence.hpp"

namespace flogmap {

/// Adds what every ray of the view says about every cell that it crosses.
void integrate_ray_by_ray(const RayModel& model, const GridSpec& grid, const View& view,
                          ViewEvidence& evidence);

}  // namespace flogmap
