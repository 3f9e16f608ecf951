// The mission seen from above: seabed, contours, tracks, plans, and where packets were lost.
#pragma once

#include <string>

#include "clients/mission/mission_store.h"

namespace halocline::clients {

// An SVG element; empty where no vehicle has a place. Losses that would lie upon each other are one mark: one for each class of
// outcomes in a square of 14 pixels. Tracks have at most 400 points each, 300 vehicles at most are drawn. Throws as
// run_gnuplot (plot.h).
std::string mission_chart(const MissionStore& mission);

}  // namespace halocline::clients
