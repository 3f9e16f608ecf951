// SPDX-License-Identifier: BSD-3-Clause
// How much of a hull lies under water, so that a vehicle at the surface floats and one above it falls.
//
// A spheroid is cut across its axis into sections; each counts as a circle cut by the water level at the
// depth of its centre, weighted by its volume. Exact for a level hull; for one that is pitched the cut
// through a section is taken as level, an error below one section's radius in depth. Waves tilt and lift the
// level at each section as the surface's tangent plane does.
//
// Floats are wall-sided hulls by which buoys and boats float, heave and right themselves: each is an elliptic
// cylinder along the body's z axis, cut by the surface's tangent plane at the vehicle. It is summed over
// eight columns on the ellipse of 1/sqrt(2) of its size, which have the area and the second moments of the
// whole section, so volume and centroid of the wet part are exact while the plane cuts the walls alone: heave
// stiffness rho g A, and metacentric heights of I / V (Fossen 2021, section 4.2). Beyond, as the deck dips or
// the bottom rises, column by column. Frame: body, about CO, metres.
//
// Left out: the water a hull carries with it, the change of added mass, the curvature of the surface over the
// hull, run-up, water on deck, slamming.
#pragma once

#include <vector>

#include "core/frames.h"
#include "vehicle_sim/dynamics/body_axes.h"
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

// Exactly {1, 1, 0} for a hull that is wholly submerged. `surface_z_m` of the surface above or below CO;
// `slope`: Water's.
Submergence submergence(const ModelParameters& model, const VehicleState& state, double surface_z_m,
                        const Vec3& slope = Vec3::Zero());

// Share of a circle's area below the water level, its centre `depth` (positive under water) from the level,
// in units of the radius: 0 at -1 or less, 1/2 at 0, 1 at 1 or more.
double submerged_share_of_circle(double depth_in_radii);

// What is wet of the floats.
struct WetFloats {
  double volume_m3 = 0;
  Axes moment_m4;           // of the volume: its centroid times it
  double bottom_share = 0;  // of the bottom's area that is wet, 0 to 1: 1 however little the hull dips in
};

// `surface_below_co_m`: z of the surface at CO less that of CO; `down`: the world's down axis; `slope`: of
// the surface, (dz/dnorth, dz/deast, 0); both turned to the body frame.
WetFloats wet_floats(const std::vector<Float>& floats, double surface_below_co_m, const Axes& down,
                     const Axes& slope);

}  // namespace halocline::vehicle_sim
