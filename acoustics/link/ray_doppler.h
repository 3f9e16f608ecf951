// SPDX-License-Identifier: BSD-3-Clause
// Doppler factor of each path of a link, from its angles and the velocities of both ends.
//
// Model: every path has its own shift, by the velocity of each end along the direction of the ray there:
//   f_rx / f_tx = (1 - v_r / c_r) / (1 - v_s / c_s),
// v_s the velocity of the source along the direction in which the ray leaves, v_r that of the receiver along
// the direction in which it arrives, both positive with the ray. Exact for steady motion over the length of a
// signal. The factor comes from angles, not from differences of delays, and hence is smooth from step to
// step. Left out: motion of the surface, bottoms that slope across the link.
#pragma once

#include "acoustics/rays/eigenray.h"
#include "core/frames.h"

namespace halocline::acoustics {

// Positions and velocities of both ends, NED world frame, m and m/s, with the sound speed at each, m/s.
struct MovingEnds {
  Vec3 source_ned_m, source_velocity_mps;
  Vec3 receiver_ned_m, receiver_velocity_mps;
  double source_sound_speed_mps, receiver_sound_speed_mps;
};

// Unit vector, NED, of a ray at `angle_rad` (positive down) that heads from one end to the other; it heads
// north when one end is above the other.
Vec3 ray_direction(const Vec3& from_ned_m, const Vec3& to_ned_m, double angle_rad);

// Factor f_rx / f_tx of one path. Throws InvalidArgument unless both speeds are below that of sound.
double doppler_factor(const Eigenray& path, const MovingEnds& ends);

// Factor f_rx / f_tx for velocities along the path: `source_mps` towards the receiver, `receiver_mps` away
// from the source.
double doppler_factor(double source_mps, double source_sound_speed_mps, double receiver_mps,
                      double receiver_sound_speed_mps);

// The relative shift, the factor minus 1, without loss of digits when it is small.
double doppler_shift(double source_mps, double source_sound_speed_mps, double receiver_mps,
                     double receiver_sound_speed_mps);

}  // namespace halocline::acoustics
