// SPDX-License-Identifier: BSD-3-Clause
// Platform jitter: how the mean power of interfering paths varies as both ends of a link move vertically from
// packet to packet.
//
// Model: the ends move by u J and v J, u and v independent standard normal variables and J =
// kPlatformJitterM. The interference of two paths p, q is, with the wave number k and the differences a, b of
// the sines of their launch and arrival angles,
//   I cos(phase + k J (a u + b v)).
// Its mean is g I cos(phase), g = exp(-x / 2), x = (k J)^2 (a^2 + b^2). The variance of the sum over pairs is
// taken order by order in Hermite polynomials of u and v (Wiener's chaos; Janson 1997, Gaussian Hilbert
// Spaces): the first two orders are
//   |sum g I sin(phase) k J (a, b)|^2 + 1/2 |sum g I cos(phase) (k J)^2 (a, b)(a, b)^T|^2  (Frobenius),
// exact, since pairs of few radians turn together: where three paths cancel each other, their interference
// hardly varies although that of each pair does. Of higher orders, in which pairs of many radians turn, the
// variances of pairs add; a single pair has in all
//   I^2 (1 - g^2) (1 - g^2 cos(2 phase)) / 2.
#pragma once

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"

namespace halocline::acoustics {

// Vertical platform jitter J, m rms (our choice).
inline constexpr double kPlatformJitterM = 0.2;

// Accumulates the pairs of paths of one link.
class JitterVariance {
 public:
  // `wave_number` in rad/m.
  explicit JitterVariance(double wave_number) : turn_(wave_number * kPlatformJitterM) {}

  // Adds a pair: I cos(phase) and I sin(phase) at the given positions, uPa^2, and the differences of the
  // sines of its angles. Returns g.
  double add(double cosine_part, double sine_part, double launch_sines, double arrival_sines) {
    const double u = turn_ * launch_sines, v = turn_ * arrival_sines, x = u * u + v * v,
                 kept = fast_exp(-x / 2), squares = kept * kept;
    const double cosine = kept * cosine_part, sine = kept * sine_part;
    by_u_ += sine * u;
    by_v_ += sine * v;
    by_uu_ += cosine * u * u;
    by_uv_ += cosine * u * v;
    by_vv_ += cosine * v * v;
    // The variance of the pair alone less its first two orders, at least 0 but for rounding.
    const double cosines = cosine_part * cosine_part, sines = sine_part * sine_part;
    const double alone = (1 - squares) * (cosines + sines - squares * (cosines - sines)) / 2;
    higher_ += alone - squares * (sines * x + cosines * x * x / 2);
    return kept;
  }
  // Variance of the sum, uPa^4.
  double variance() const {
    const double higher = higher_ > 0 ? higher_ : 0;
    return squared(by_u_) + squared(by_v_) + (squared(by_uu_) + 2 * squared(by_uv_) + squared(by_vv_)) / 2 +
           higher;
  }

 private:
  double turn_;
  double by_u_ = 0, by_v_ = 0, by_uu_ = 0, by_uv_ = 0, by_vv_ = 0, higher_ = 0;
};

}  // namespace halocline::acoustics
