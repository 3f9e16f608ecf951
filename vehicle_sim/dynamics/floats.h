// Buoyancy of wall-sided hulls that pierce the sea surface: what makes buoys and boats float, heave and right themselves.
//
// Model: each float is an elliptic cylinder along the body's z axis, cut by the surface's tangent plane at the vehicle. It is
// summed over eight columns on the ellipse of 1/sqrt(2) of its size, which have the area and the second moments of the whole
// section, so volume and centroid of the wet part are exact while the plane cuts the walls alone: heave stiffness rho g A, and
// metacentric heights of I / V (Fossen 2021, section 4.2). Beyond, as the deck dips or the bottom rises, column by column.
// Frame: body, about CO, metres. Left out: the curvature of the surface over the hull, run-up, water on deck, slamming.
#pragma once

#include <vector>

#include "vehicle_sim/dynamics/body_axes.h"
#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

// What is wet of the floats.
struct WetFloats {
  double volume_m3 = 0;
  Axes moment_m4;           // of the volume: its centroid times it
  double bottom_share = 0;  // of the bottom's area that is wet, 0 to 1: 1 however little the hull dips in
};

// `surface_below_co_m`: z of the surface at CO less that of CO; `down`: the world's down axis; `slope`: of the surface,
// (dz/dnorth, dz/deast, 0); both turned to the body frame.
WetFloats wet_floats(const std::vector<Float>& floats, double surface_below_co_m, const Axes& down,
                     const Axes& slope);

}  // namespace halocline::vehicle_sim
