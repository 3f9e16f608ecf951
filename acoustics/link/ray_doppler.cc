// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/ray_doppler.h"

#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

void require_slower_than_sound(double source_mps, double source_sound_speed_mps, double receiver_mps,
                               double receiver_sound_speed_mps) {
  require(std::abs(source_mps) < source_sound_speed_mps && std::abs(receiver_mps) < receiver_sound_speed_mps,
          "an end of a link moves at the speed of sound or faster");
}

}  // namespace

Vec3 ray_direction(const Vec3& from_ned_m, const Vec3& to_ned_m, double angle_rad) {
  Vec3 along = to_ned_m - from_ned_m;
  along.z() = 0;
  const double range = along.norm();
  along = range > 0 ? Vec3(along / range) : Vec3(1, 0, 0);
  return elementary::cos(angle_rad) * along + elementary::sin(angle_rad) * Vec3(0, 0, 1);
}

double doppler_factor(const Eigenray& path, const MovingEnds& ends) {
  const Vec3 leaves = ray_direction(ends.source_ned_m, ends.receiver_ned_m, path.launch_angle_rad);
  const Vec3 comes = ray_direction(ends.source_ned_m, ends.receiver_ned_m, path.arrival_angle_rad);
  return doppler_factor(ends.source_velocity_mps.dot(leaves), ends.source_sound_speed_mps,
                        ends.receiver_velocity_mps.dot(comes), ends.receiver_sound_speed_mps);
}

double doppler_factor(double source_mps, double source_sound_speed_mps, double receiver_mps,
                      double receiver_sound_speed_mps) {
  require_slower_than_sound(source_mps, source_sound_speed_mps, receiver_mps, receiver_sound_speed_mps);
  // f_rx / f_tx = (1 - v_r / c_r) / (1 - v_s / c_s), both velocities along the ray.
  return (1 - receiver_mps / receiver_sound_speed_mps) / (1 - source_mps / source_sound_speed_mps);
}

double doppler_shift(double source_mps, double source_sound_speed_mps, double receiver_mps,
                     double receiver_sound_speed_mps) {
  require_slower_than_sound(source_mps, source_sound_speed_mps, receiver_mps, receiver_sound_speed_mps);
  // The Doppler factor minus 1, in a form without cancellation.
  const double source = source_mps / source_sound_speed_mps,
               receiver = receiver_mps / receiver_sound_speed_mps;
  return (source - receiver) / (1 - source);
}

}  // namespace halocline::acoustics
