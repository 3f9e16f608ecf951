// SPDX-License-Identifier: BSD-3-Clause
// Style of a vehicle: one colour, the same in every picture of a page, and from the ninth vehicle on also a
// dash pattern.
//
// There are eight colours for a light page and eight for a dark one. Each has a contrast of 3 or more to its
// background, and any two differ by 0.1 or more in OKLab (Ottosson 2020), for normal vision and for each of
// the three kinds of colour blindness (Machado, Oliveira and Fernandes 2009, severity 1).
#pragma once

#include <string>

#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {

// Returns the page's variable for the vehicle's colour: "v-3".
std::string colour_of(const VehicleRecord& vehicle);
// Returns the classes of a line for the vehicle: "v-3 dash-1"; empty for null, a line in the colour of text.
std::string classes_of(const VehicleRecord* vehicle);

// Returns a short piece of the vehicle's line, centred on (x, y), for the label of a lane.
std::string swatch(const VehicleRecord* vehicle, double x, double y);

// Return the style sheet of vehicles: their colours for one scheme, and the classes of lines.
std::string vehicle_style(bool on_dark);
std::string vehicle_classes();

}  // namespace halocline::clients
