// How much of a hull lies under water, so that a vehicle at the surface floats and one above it falls.
//
// Model: the hull, a spheroid about its axis, is cut across the axis into sections; each counts as a circle
// cut by the water level at the depth of its centre, weighted by its volume. Exact for a level hull; for one
// that is pitched the cut through a section is taken as level, an error below one section's radius in depth.
// Waves tilt and lift the level at each section as the surface's tangent plane does. Left out: the water a hull carries with it,
// the change of added mass. Hulls with floats are not this: floats.h.
#pragma once

#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

struct Submergence {
  double hull = 1;   // share of the hull's volume under water, 0 to 1
  double stern = 1;  // share of the propeller's disc under water, 0 to 1
  double x_shift_m =
      0;  // how far the centre of buoyancy moves along the body's x axis; 0 when all or none is under
};

// True whenever the origin lies deeper than half a length plus a diameter.
inline bool is_wholly_submerged(const HullShape& hull, double depth_m) {
  return depth_m > hull.length_m / 2 + hull.diameter_m;
}

// Exactly {1, 1, 0} for a hull that is wholly submerged. `surface_z_m` of the surface above or below CO; `slope`: Water's.
Submergence submergence(const ModelParameters& model, const VehicleState& state, double surface_z_m,
                        const Vec3& slope = Vec3::Zero());

// Share of a circle's area below the water level, its centre `depth` (positive under water) from the level,
// in units of the radius: 0 at -1 or less, 1/2 at 0, 1 at 1 or more.
double submerged_share_of_circle(double depth_in_radii);

}  // namespace halocline::vehicle_sim
