// SPDX-License-Identifier: BSD-3-Clause
// The look of a vehicle: one colour, the same in every picture of a page, and from the ninth vehicle on a
// dash as well.
//
// Eight colours for a light page and eight for a dark one. Each stands out from its paper (contrast 3 or
// more), and any two differ by 0.1 or more in OKLab (Ottosson 2020), for normal eyes and for each of the
// three kinds of colour blindness (Machado, Oliveira and Fernandes 2009, severity 1).
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "clients/mission/mission_vehicle.h"

namespace halocline::clients {

struct VehicleColour {
  const char* on_light;
  const char* on_dark;
};

inline constexpr std::size_t kVehicleColours = 8;
const std::array<VehicleColour, kVehicleColours>& vehicle_colours();

// The page's variable of its colour: "v-3".
std::string colour_of(const MissionVehicle& vehicle);
// The classes of a line of it, "v-3 dash-1"; empty for null: a line in ink.
std::string classes_of(const MissionVehicle* vehicle);

// A short piece of its line, centred on (x, y), for the label of a lane.
std::string swatch(const MissionVehicle* vehicle, double x, double y);

// The style sheet of all this.
std::string vehicle_style(bool on_dark);
std::string vehicle_classes();

}  // namespace halocline::clients
