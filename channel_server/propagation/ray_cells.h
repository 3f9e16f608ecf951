// Between which points the paths of a link are searched, so that one search serves links that differ little.
//
// Rule. Range and both depths are each replaced by the middle of their cell: cells are `distance_m` long in
// range and a tenth of that in depth (fronts of sound that travels nearly level bend most across depth), and
// half as large as often as it takes for a link to be at least 20 cells long. Below 20 / 64 of `distance_m`
// nothing is replaced. So the searched link is a function of the link alone, whatever was searched before, and
// lies within 2.5 % of the range in range and 0.25 % of it in depth. acoustics/link/extrapolate_arrivals.h takes the paths
// from there to the link.
#pragma once

#include <optional>

#include "acoustics/rays/arrivals.h"

namespace halocline::channel_server {

// The link to search for; empty: this very one, as it is too short for cells of `distance_m` (above 0).
std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m);

}  // namespace halocline::channel_server
