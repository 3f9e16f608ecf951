// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/localiser_messages.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/state_extrapolation.h"

namespace halocline::clients {

OwnMotion to_motion(const vehicle_sensors_t& sensors) {
  return {.at = SimTime::from_utime(sensors.utime),
          .water_speed_mps = sensors.water_speed_mps,
          .heading_rad = sensors.heading_rad,
          .pitch_rad = sensors.pitch_rad,
          .depth_m = sensors.depth_m};
}

acoustics::SoundSpeedProfile to_profile(const environment_t& environment) {
  std::vector<acoustics::SpeedRow> rows;
  for (std::size_t i = 0; i < environment.layer_depth_m.size(); ++i)
    rows.push_back({environment.layer_depth_m[i], environment.layer_sound_speed_mps[i]});
  // Travel times do not depend on absorption, so one temperature and salinity do for all layers.
  return acoustics::SoundSpeedProfile::from_speeds(
      rows, {environment.layer_temperature_degc.front(), environment.layer_salinity_psu.front()});
}

Vec3 true_position(const vehicle_state_t& state, SimTime at) {
  return reckoned_position(Vec3(state.position_ned_m), Vec3(state.velocity_ned_mps),
                           at - SimTime::from_utime(state.utime));
}

void set_estimate(position_estimate_t& message, const PositionEstimate& estimate, double z_ned_m,
                  const EstimatorRules& rules) {
  message.estimate_status =
      estimate.hypotheses > 1 ? position_estimate_t::AMBIGUOUS : position_estimate_t::UNIQUE;
  Eigen::Map<Vec3>(message.position_ned_m) << estimate.position_ne_m, z_ned_m;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = estimate.position_covariance_m2;
  covariance(2, 2) = rules.depth_sigma_m * rules.depth_sigma_m;
  Eigen::Map<Eigen::Matrix3d>(message.covariance_ned_m2) = covariance;  // symmetric: any storage order
  Eigen::Map<Vec3>(message.current_ned_mps) << estimate.current_ne_mps, 0;
  message.likelihood = estimate.weight;
  if (!rules.estimate_clock()) return;
  message.clock_estimated = 1;
  message.clock_offset_s = estimate.clock[0];
  message.clock_drift = estimate.clock[1];
  message.clock_offset_deviation_s = std::sqrt(std::max(estimate.clock_covariance(0, 0), 0.0));
  message.clock_drift_deviation = std::sqrt(std::max(estimate.clock_covariance(1, 1), 0.0));
}

}  // namespace halocline::clients
