// SPDX-License-Identifier: BSD-3-Clause
// Vehicle model `torpedo`, the default model of a scenario.
//
// It has the hull, masses, propeller and lags of `remus100-pvs` (remus100_pvs.h) with laws that hold at every
// angle of attack and in every current: Munk moments (the full added-mass Coriolis matrix), a bounded body
// lift, cross-flow in sway and heave, fins in their local flow, a propeller in the axial flow at its shaft,
// and heave damping that decreases with speed as sway damping does. Sources of the numbers that differ:
// Prestero 2001 (MIT and WHOI thesis: fin lift slope, body lift, section drag), Hoerner 1965, Polhamus 1966.
// Range: -1 to 3 m/s, any attitude. Behaviour: straight-line speeds of `remus100-pvs`; turning radii of 5 to
// 12 m; docs/vehicles.md has the measured values. Limits: no such hull was towed for this model; another hull
// needs another file.
#pragma once

#include "vehicle_sim/dynamics/vehicle_model.h"

namespace halocline::vehicle_sim {

inline constexpr const char* kTorpedoName = "torpedo";

ModelParameters torpedo_parameters();

}  // namespace halocline::vehicle_sim
