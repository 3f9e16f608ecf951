// SPDX-License-Identifier: BSD-3-Clause
// Position fix from the bearing and the travel time of one beacon's packet (inverted USBL).
//
// Model: the beacon's position is known. The slant range is travel time times a mean sound speed; the
// horizontal range follows from the slant range and the difference of depths. The direction, measured by an
// array in the vehicle's body axes, is rotated into the world frame by the vehicle's attitude, and the
// horizontal part of it points to the beacon:
//
//   s          = c t
//   r          = sqrt(s^2 - (z_beacon - z)^2)
//   (n, e)     = (n_beacon, e_beacon) - r d,  d the unit vector of the direction's horizontal part
//   deviation^2 = (r^2) (sigma_angle^2 + sigma_heading^2) + (range_deviation s)^2
//
// The measured elevation enters through the rotation alone, so a bent ray causes little error. There is no
// fix from a beacon right above or below. Left out: the vehicle's turning between departure and arrival, the
// extra path length of bent rays.
#pragma once

#include <optional>

#include "core/frames.h"

namespace halocline::clients {

struct AcousticFixRules {
  double sound_speed_mps = 1500;          // mean along the path, above 0
  double heading_deviation_rad = 0.0175;  // 1 degree, error of the compass, 0 or above
  double range_deviation = 0.01;          // relative error of the range, from that of the sound speed
  double min_deviation_m = 0.5;           // lower limit of a fix's deviation, above 0
};

// Direction and travel time as a modem with an array measures them.
struct BeaconMeasurement {
  double bearing_rad = 0;    // from the bow towards starboard
  double elevation_rad = 0;  // above the plane of the forward and starboard axes
  double angle_deviation_rad = 0;
  double travel_time_s = 0;  // one way
};

struct PlaceFix {
  double north_m = 0, east_m = 0;
  double deviation_m = 0;
};

// Returns the fix; empty when the sound came from nearly straight above or below. `attitude` and `own_z_m`:
// the vehicle's own at the reception.
std::optional<PlaceFix> place_by_beacon(const AcousticFixRules& rules, const Vec3& beacon_ned_m,
                                        const BeaconMeasurement& measured, const EulerAngles& attitude,
                                        double own_z_m);

}  // namespace halocline::clients
