// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_drift.h"

#include <algorithm>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"
#include "core/gauss_markov.h"
#include "core/random.h"
#include "core/sim_time.h"

namespace halocline::acoustics {

void validate(const ProfileDrift& drift) {
  require_in_range(drift.spread_mps, 0, 10, "spread of the sound-speed profile", "m/s");
  require_in_range(drift.time_s, 0.1, 1e6, "correlation time of the sound-speed profile", "s");
  require_in_range(drift.depth_m, 1, ProfileDrift::kDeepestM, "depth of the drifting profile", "m");
}

DriftAmplitudes drift_amplitudes(const ProfileDrift& drift, std::int64_t block) {
  const SimTime begin =
      SimTime::from_seconds(ProfileDrift::kBlockS * static_cast<double>(std::max<std::int64_t>(block, 0)));
  const auto amplitude = [&](std::uint32_t mode) {
    const DrawAddress address{.seed = drift.seed, .purpose = purpose_of("profile-drift"), .who = mode};
    return GaussMarkovProcess(drift.spread_mps, drift.time_s, address).at(begin);
  };
  return {amplitude(1), amplitude(2)};
}

std::vector<SpeedRow> drift_rows(double depth_m, const DriftAmplitudes& amplitudes) {
  constexpr int kSteps = 16;
  std::vector<SpeedRow> rows;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps, angle = std::numbers::pi * share;
    rows.push_back({depth_m * share, amplitudes.first_mps * elementary::cos(angle) +
                                         amplitudes.second_mps * elementary::cos(2 * angle)});
  }
  rows.push_back({2 * depth_m, 0});
  return rows;
}

}  // namespace halocline::acoustics
