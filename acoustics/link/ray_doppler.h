// SPDX-License-Identifier: BSD-3-Clause
// Doppler of each path of a link, from its angles and the velocities of both ends.
//
// Model: along a ray what counts is the velocity of each end along the ray's own direction there, so every
// path has its own shift: f_rx / f_tx = (1 - v_r / c_r) / (1 - v_s / c_s), v_s of the source along the
// direction in which the ray leaves, v_r of the receiver along the direction in which it comes in (both
// positive with the ray). Exact for steady motion over the length of a signal. From angles, not from
// differences of delays, so it is smooth from step to step. Left out: motion of the surface, bottoms that
// slope across the link.
#pragma once

#include "acoustics/rays/arrivals.h"
#include "core/frames.h"

namespace halocline::acoustics {

// Ends of a link in motion, NED world frame, m and m/s; sound speed at each, m/s.
struct MovingEnds {
  Vec3 source_ned_m, source_velocity_mps;
  Vec3 receiver_ned_m, receiver_velocity_mps;
  double source_sound_speed_mps, receiver_sound_speed_mps;
};

// Unit vector, NED, of a ray of angle `angle_rad` (positive down) heading from one end to the other; north
// when one is right above the other.
Vec3 ray_direction(const Vec3& from_ned_m, const Vec3& to_ned_m, double angle_rad);

// f_rx / f_tx of one path. Speeds have to be below that of sound (InvalidArgument otherwise).
double doppler_factor(const Arrival& path, const MovingEnds& ends);

// f_rx / f_tx of velocities along the path: `source_mps` towards the receiver, `receiver_mps` away from the
// source.
double doppler_factor(double source_mps, double source_sound_speed_mps, double receiver_mps,
                      double receiver_sound_speed_mps);

// The same less 1, the relative shift, without loss of digits where it is small.
double doppler_shift(double source_mps, double source_sound_speed_mps, double receiver_mps,
                     double receiver_sound_speed_mps);

}  // namespace halocline::acoustics
