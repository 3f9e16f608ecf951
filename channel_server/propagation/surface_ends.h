// SPDX-License-Identifier: BSD-3-Clause
// Ends of links among the waves: which of them are under water, which follow the surface, which heave.
//
// An end at a fixed mean depth z is under water for the share Phi(z / sigma) of the time, sigma the rms
// height of the waves; out of the water it sends and hears nothing. Whether it is at an instant is the sign
// of z / sigma + x(t), with x the real part of complex noise (acoustics/fading/complex_noise.h) of the waves'
// mean frequency, one an end. So it lasts for about half a period of the waves, and is a function of seed,
// vehicle and time alone. A floating end follows the surface and is always under water. An end heaves unless
// it is moored or lies on the bottom.
//
// Left out: waves that two ends close to each other share, and spray.
#pragma once

#include <cstdint>
#include <set>

#include "acoustics/sea/environment.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct SurfaceEnds {
  std::uint64_t seed = 0;
  std::set<VehicleId> floating = {};  // ends that follow the surface
  std::set<VehicleId> heaving = {};   // ends that move with the water

  // Returns the share of the time for which an end at that z is under water; 1 for a floating end.
  double share_under_water(VehicleId id, double z_m, const acoustics::Environment& environment) const;
  // True when the end is under water at `at`.
  bool is_under_water(VehicleId id, double z_m, const acoustics::Environment& environment, SimTime at) const;
  // Returns the rms vertical velocity with which the waves move an end, m/s.
  double heave_mps(VehicleId id, double z_m, const acoustics::Environment& environment) const;
};

}  // namespace halocline::channel_server
