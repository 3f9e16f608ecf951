// What bounces do to a traced ray beside its direction and its tube: events, counts, losses and phases.
//
// Immutable: calls may overlap between threads.
#pragma once

#include <cmath>
#include <vector>

#include "acoustics/rays/traced_ray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"

namespace halocline::acoustics {

class BounceLosses {
 public:
  // `deepest_speed_mps`: of the water at the deepest bottom.
  BounceLosses(const ProfiledSea& sea, double deepest_speed_mps);

  // Notes a bounce; false where the ray is given up: it has bounced too often, or its bounces leave less than a quarter of the
  // least factor. With `details` losses are exact. Sines of the grazing angle.
  [[nodiscard]] bool at_surface(double sine, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool at_bottom(const Facet& facet, double sine, double speed_mps, TracedRay& ray,
                               TracedDetails* details) const;

  // Whether the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const {
    return bounces > options_.max_bounces || (bounces > 0 && std::abs(theta) > options_.max_launch_angle_rad);
  }

 private:
  double rough_bottom_factor(double sine) const;

  RayOptions options_;
  FluidBottom bottom_;
  SurfaceLoss surface_loss_;
  double min_factor_;
  std::vector<double> bottom_factor_;  // at sines 0..1, evenly: enough to give up faint rays by
};

}  // namespace halocline::acoustics
