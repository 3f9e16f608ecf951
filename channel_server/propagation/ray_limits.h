// What the search of one link's paths needs: its solver, how many bounces; and the number of a path that it found.
#pragma once

#include <cstdint>
#include <optional>

#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "core/units.h"

namespace halocline::channel_server {

// Bounces that a link's paths may have: 0.6 of range over mean depth (above 0), 60 at least and 10 000 at most. A path that
// drops by the depth D from one bounce to the next meets the boundaries r tan(angle) / D times over the range r, so these are
// all up to 31 degrees, the critical angle of medium sand; steeper ones lose several dB at each bounce.
int bounces_for(double range_m, double depth_m);

// Of the bottom between the ends of a link, m.
double mean_depth_m(const acoustics::BottomProfile& bottom, double range_m);

// What the level of a link may have beside the sum of its paths' powers in even water (acoustics/link/least_loss.h), our
// choices: 10 dB where phasors are added, 3 dB where only those whose fading keeps together are; 10 dB for the tail of
// reverberation; 6 dB where the straight path, which serves without a bottom, spreads less than by 1.5 * 10 log r.
Decibels gain_beyond_powers(const RayModel& model, const acoustics::Environment& environment);

// The solver that is wanted where it can do the link, else the simplest that can; empty: the simplest.
std::optional<acoustics::RaySolver> usable_solver(std::optional<acoustics::RaySolver> wanted,
                                                  const acoustics::RaySea& sea,
                                                  const acoustics::RayLink& link);

// Of a path as it was found, from the link's lower end: the same for both directions.
std::uint64_t number_of(const acoustics::PathIdentity& identity);

}  // namespace halocline::channel_server
