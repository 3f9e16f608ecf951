// SPDX-License-Identifier: BSD-3-Clause
// Submerged part of a hull, so that a vehicle at the surface floats and one above it falls.
//
// A spheroid is cut across its axis into sections. Each counts as a circle cut by the water level at the
// depth of its centre, weighted by its volume. This is exact for a level hull. For a pitched hull the cut
// through a section is taken as level, an error below one section's radius in depth. In waves the level at
// each section is that of the tangent plane of the surface.
//
// Floats are wall-sided hulls on which buoys and boats float, heave and right themselves. Each is an elliptic
// cylinder along the body's z axis, cut by the tangent plane of the surface at the vehicle. It is summed over
// eight columns on the ellipse of 1/sqrt(2) of its size, which have the area and the second moments of the
// whole section. Volume and centroid of the wet part are thus exact while the plane cuts the walls alone: the
// heave stiffness is rho g A, and the metacentric radius I / V (Fossen 2021, section 4.2). When the deck dips
// in or the bottom rises out, the sum is approximate, column by column. Frame: body, about CO, metres.
//
// Left out: water carried along by a hull, the change of added mass, the curvature of the surface over the
// hull, run-up, water on deck, slamming.
#pragma once

#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"

namespace halocline::vehicle_sim {

struct Submergence {
  double hull = 1;   // submerged share of the hull's volume, 0 to 1
  double stern = 1;  // submerged share of the propeller's disc, 0 to 1
  // Shift of the centre of buoyancy along the body's x axis, m; 0 when all or none of the hull is submerged.
  double x_shift_m = 0;
};

// True for any attitude when CO is deeper than half a length plus a diameter.
inline bool is_wholly_submerged(const HullShape& hull, double depth_m) {
  return depth_m > hull.length_m / 2 + hull.diameter_m;
}

// Returns exactly {1, 1, 0} for a hull that is wholly submerged. `surface_z_m`: z of the surface above or
// below CO; `slope`: Water::surface_slope.
Submergence submergence(const ModelParameters& model, const VehicleState& state, double surface_z_m,
                        const Vec3& slope = Vec3::Zero());

// Returns the share of a circle's area below the water level. `depth_in_radii`: depth of its centre, positive
// under water, in units of the radius. 0 at -1 or less, 1/2 at 0, 1 at 1 or more.
double submerged_share_of_circle(double depth_in_radii);

struct WetFloats {
  double volume_m3 = 0;
  Axes moment_m4;           // volume times its centroid
  double bottom_share = 0;  // wet share of the bottom's area, 0 to 1: 1 as soon as the hull dips in
};

// `surface_below_co_m`: z of the surface at CO less z of CO; `down`: the world's down axis; `slope`: slope of
// the surface, (dz/dnorth, dz/deast, 0). Both vectors are in the body frame.
WetFloats wet_floats(const std::vector<Float>& floats, double surface_below_co_m, const Axes& down,
                     const Axes& slope);

}  // namespace halocline::vehicle_sim
