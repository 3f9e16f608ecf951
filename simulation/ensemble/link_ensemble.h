// SPDX-License-Identifier: BSD-3-Clause
// Bands of the forecast of one link over the members of an ensemble (sea_member.h).
#pragma once

#include <cstddef>

#include "simulation/composition.h"
#include "simulation/ensemble/sea_member.h"
#include "simulation/link_survey.h"

namespace halocline::clients {

// Numbers of members that a forecast may have.
inline constexpr std::size_t kStandardMembers = 20, kMostMembers = 1000;

// Bands of one link: received level, dB re 1 uPa; signal-to-noise ratio, dB; delivery probability. Members
// without a path count with the level of silence.
struct LinkBands {
  std::size_t members = 0;
  ForecastBand level_db, snr_db, delivery;
};

// Computes the link in `members` (1 to kMostMembers) seas, each as survey_link() does at time 0; the work is
// that of as many links. Throws as survey_link() does.
LinkBands link_bands(const ScenarioConfig& config, const LinkSurveyEnd& from, const LinkSurveyEnd& to,
                     std::size_t members);

}  // namespace halocline::clients
