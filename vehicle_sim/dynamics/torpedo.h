// SPDX-License-Identifier: BSD-3-Clause
// The vehicle `torpedo`: the model that scenarios use unless they name another.
//
// The hull, masses, propeller and lags of `remus100-pvs` (remus100_pvs.h) with laws that hold at every angle
// of attack and in every current: Munk moments (the whole added-mass Coriolis matrix), a bounded body lift,
// cross-flow in sway and heave, fins that feel the flow where they stand, a propeller that feels the water
// along its shaft, heave damping that falls with speed as that of sway. Sources of the numbers that differ:
// Prestero 2001 (MIT and WHOI thesis: fin lift slope, body lift, section drag), Hoerner 1965, Polhamus 1966.
// Range: -1 to 3 m/s, any attitude. Behaviour: straight speeds of `remus100-pvs`; turns of 5 to 12 m; see
// docs/vehicles.md for what was measured. Limits: a hull like it was never towed for this model; another hull
// is another file.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kTorpedoName = "torpedo";

ModelParameters torpedo_parameters();

}  // namespace halocline::vehicle_sim
