// SPDX-License-Identifier: BSD-3-Clause
// A place from where a beacon's sound came from and how long it was on its way.
//
// Model: the beacon's place is known; the slant range is travel time times a mean sound speed; the horizontal
// range follows from it and the two depths; the direction, measured by an array about the vehicle's own axes,
// is turned into the world by the vehicle's own attitude, and its horizontal part is where the beacon lies.
// The measured elevation enters through that turn alone, so a bent ray hurts little. Deviation: of the range,
// and of angle and heading together times the horizontal range. Useless for a beacon right above or below.
// Left out: the turn between departure and arrival, the way of the sound's bending.
#pragma once

#include <optional>

#include "core/frames.h"

namespace halocline::clients {

struct AcousticFixRules {
  double sound_speed_mps = 1500;          // mean along the way, above 0
  double heading_deviation_rad = 0.0175;  // of the compass, 0 or above: 1 degree
  double range_deviation = 0.01;          // of the range, relative: the sound speed is not known
  double min_deviation_m = 0.5;           // of any fix, above 0
};

// As an array measures it.
struct BeaconMeasurement {
  double bearing_rad = 0;    // from the bow by starboard
  double elevation_rad = 0;  // above the plane of forward and starboard
  double angle_deviation_rad = 0;
  double travel_time_s = 0;  // one way
};

struct PlaceFix {
  double north_m = 0, east_m = 0;
  double deviation_m = 0;
};

// `attitude` and `own_z_m` of the vehicle at the reception. Empty where the sound came from straight above or
// below.
std::optional<PlaceFix> place_by_beacon(const AcousticFixRules& rules, const Vec3& beacon_ned_m,
                                        const BeaconMeasurement& measured, const EulerAngles& attitude,
                                        double own_z_m);

}  // namespace halocline::clients
