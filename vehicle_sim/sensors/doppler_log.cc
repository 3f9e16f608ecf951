// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensors/doppler_log.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Dense>

#include "core/elementary.h"

namespace halocline::vehicle_sim {
namespace {

using std::numbers::pi;
constexpr int kFirstRangeDraw = 4;  // draws 0 to 3 are for the beams' speeds, 4 to 7 for their ranges

// Unit vectors at `angle` from the down axis, at azimuths of 45, 135, 225 and 315 degrees from `yaw`.
std::array<Vec3, 4> beams_at(double angle, double yaw) {
  std::array<Vec3, 4> beams;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const double azimuth = yaw + pi / 4 + static_cast<double>(k) * pi / 2;
    beams[k] = {elementary::sin(angle) * elementary::cos(azimuth),
                elementary::sin(angle) * elementary::sin(azimuth), elementary::cos(angle)};
  }
  return beams;
}

// Velocity by least squares of b_k . v = s_k over the locked beams, with the assumed beam directions:
//
//   (sum b_k b_k^T) v = sum s_k b_k
void solve_velocity(const DvlSettings& dvl, DvlReading& reading) {
  const std::array<Vec3, 4> beams = believed_dvl_beams(dvl);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  int locked = 0;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    if (reading.beams[k].status != AltitudeStatus::kMeasured) continue;
    ++locked;
    normal += beams[k] * beams[k].transpose();
    right += reading.beam_speed_mps[k] * beams[k];
  }
  reading.valid = locked >= 3;
  if (reading.valid) reading.ground_velocity_body_mps = normal.ldlt().solve(right);
}

Echo with_errors(const Echo& echo, bool dropped, double error_m) {
  if (echo.status != AltitudeStatus::kMeasured) return {echo.status, 0};
  if (dropped) return {AltitudeStatus::kNoBottom, 0};
  return {AltitudeStatus::kMeasured, std::max(0.0, echo.range_m + error_m)};
}

}  // namespace

std::array<Vec3, 4> believed_dvl_beams(const DvlSettings& dvl) {
  return beams_at(dvl.beam_angle_rad, dvl.mounting_yaw_rad);
}

std::array<Vec3, 4> true_dvl_beams(const DvlSettings& dvl) {
  return beams_at(dvl.beam_angle_rad, dvl.mounting_yaw_rad + dvl.misalignment_rad);
}

std::array<EchoBeam, 4> dvl_beams(const DvlSettings& dvl, const VehicleState& state) {
  const std::array<Vec3, 4> directions = true_dvl_beams(dvl);
  std::array<EchoBeam, 4> beams;
  for (std::size_t k = 0; k < beams.size(); ++k) {
    beams[k] = {state.position_ned_m + state.orientation * dvl.place_m, state.orientation * directions[k],
                dvl.range_m};
  }
  return beams;
}

std::vector<double> sonar_azimuths_rad(const SonarSettings& sonar) {
  if (sonar.rays == 1) return {0};
  std::vector<double> azimuths;
  for (int i = 0; i < sonar.rays; ++i)
    azimuths.push_back(sonar.sector_rad * (static_cast<double>(i) / (sonar.rays - 1) - 0.5));
  return azimuths;
}

std::vector<EchoBeam> sonar_beams(const SonarSettings& sonar, const VehicleState& state) {
  const Vec3 origin = state.position_ned_m + state.orientation * sonar.place_m;
  const Vec3 ahead(elementary::cos(sonar.tilt_rad), 0, elementary::sin(sonar.tilt_rad));
  std::vector<EchoBeam> beams;
  for (const double azimuth : sonar_azimuths_rad(sonar)) {
    const Vec3 direction = elementary::cos(azimuth) * ahead + elementary::sin(azimuth) * Vec3::UnitY();
    beams.push_back({origin, state.orientation * direction, sonar.range_m});
  }
  return beams;
}

// Speed along each beam, by the velocity v of CO, the angular rate omega and the instrument's position r:
//
//   s_k = (1 + scale) b_k . (v + omega x r) + bias + walk + noise
DvlReading read_dvl(const DvlSettings& dvl, const SensorIdentity& sensor, std::int64_t sample,
                    const VehicleState& state, std::span<const Echo> echoes, double bias_walk_mps) {
  DvlReading reading;
  const std::array<Vec3, 4> beams = true_dvl_beams(dvl);
  const Vec3 velocity =
      Vec3(state.linear_velocity_body_mps()) + Vec3(state.angular_velocity_body_radps()).cross(dvl.place_m);
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const int part = static_cast<int>(k);
    const double range_error = dvl.range_noise_m * noise_draw(sensor, sample, kFirstRangeDraw + part);
    reading.beams[k] =
        with_errors(echoes[k], drops_out(sensor, sample, dvl.errors.dropout, part), range_error);
    if (reading.beams[k].status != AltitudeStatus::kMeasured) continue;
    reading.beam_speed_mps[k] = (1 + dvl.scale_error) * beams[k].dot(velocity) + dvl.errors.bias +
                                bias_walk_mps + dvl.errors.noise * noise_draw(sensor, sample, part);
  }
  solve_velocity(dvl, reading);
  return reading;
}

std::vector<Echo> read_sonar(const SonarSettings& sonar, const SensorIdentity& sensor, std::int64_t sample,
                             std::span<const Echo> echoes) {
  std::vector<Echo> read;
  for (std::size_t k = 0; k < echoes.size(); ++k) {
    const int part = static_cast<int>(k);
    const double error = sonar.errors.bias + sonar.errors.noise * noise_draw(sensor, sample, part);
    read.push_back(with_errors(echoes[k], drops_out(sensor, sample, sonar.errors.dropout, part), error));
  }
  return read;
}

}  // namespace halocline::vehicle_sim
