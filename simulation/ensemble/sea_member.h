// SPDX-License-Identifier: BSD-3-Clause
// Members of an ensemble: one scenario's sea, drawn anew from what is not known of it.
//
// Each member draws seven normal numbers, with the spreads of [uncertainty] (uncertainty_config.h): two modes
// of the sound-speed profile, the wind, the noise, a margin of the receivers, one factor of the bottom's
// roughness and slope, and the sediment's row. They are stratified: the i-th number of N members takes each
// of N equally likely strata once, in an order that the scenario's seed, the number and N address (a Latin
// hypercube), so that medians and quantiles vary little with the seed. Members leave out what changes by the
// hour: slow fading and the noise's spread, which a table's delivery_low and delivery_high tell, and the
// drift of the profile, in whose place they have modes of their own. The profile of an [ocean] field stays as
// it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "channel_server/channel_server_config.h"
#include "simulation/composition.h"
#include "simulation/uncertainty_config.h"

namespace halocline::clients {

// Standard normal numbers of one member, before the spreads.
struct MemberDraws {
  double first_mode = 0, second_mode = 0, wind = 0, noise = 0, receiver = 0, bottom = 0, sediment = 0;
};

// Returns the draws of member `member` of `members` (member < members).
MemberDraws draws_of(std::uint64_t seed, std::size_t member, std::size_t members);

// Sets to 0 all that changes a level by the hour.
void still_the_hours(channel_server::ChannelServerConfig& config);

// Multiplies roughness and slope of the bottom by a factor above 0, within the ranges of their keys.
void scale_bottom(channel_server::ChannelServerConfig& config, double factor);

// Returns the scenario of a member. `depth_m` is the water's depth where it is used, which bounds the height
// of the profile's modes, m; `frequency_hz` is that of the modems.
ScenarioConfig member_of(const ScenarioConfig& config, const MemberDraws& draws, double depth_m,
                         double frequency_hz);

// Values at 10, 50 and 90 % of the members.
struct ForecastBand {
  double low = 0, median = 0, high = 0;
};

// Shares of the members below the three values of a band.
inline constexpr std::array<double, 3> kBandShares{0.1, 0.5, 0.9};

// Returns the quantile at a share (0 to 1) of at least one value: the i-th sorted value of n stands at the
// share (i + 1/2) / n, as the strata do, and between them the quantile is interpolated (Hazen's rule).
double quantile(std::vector<double> values, double share);
ForecastBand band_of(const std::vector<double>& values);

}  // namespace halocline::clients
