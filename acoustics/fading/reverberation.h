// SPDX-License-Identifier: BSD-3-Clause
// Reverberation: the tail that rough boundaries add to every packet at its receiver.
//
// Model, for water of depth D over a bottom of critical angle theta_c:
// - Lambert's law: per unit of area and solid angle, a bounce scatters the share mu sin(theta_i) sin(theta_s)
//   of the power incident at the grazing angle theta_i into the angle theta_s. For bottoms 10 log10 mu is
//   -27 dB (Mackenzie 1961; Urick 1983, chapter 8). Over all directions that is the share pi mu of the
//   incident power, at any angle; q = sin^2(theta_c) of it stays below the critical angle
//   (acoustics/fading/path_fading.h).
// - Source of the tail: a path of power P and delay t0 with N_b bounces at the bottom and N_s at the surface
//   contributes
//     R = P q (N_b pi mu_b + N_s pi mu_s).
//   Sound scattered once, evenly over all azimuths, in a duct in which it spreads cylindrically comes from
//   ellipses about both ends (in elliptic coordinates dA / (R1 R2) = du dv and t = t0 cosh u):
//     dI/dt = R exp(-b (t - t0)) / sqrt(t^2 - t0^2),  t > t0.
//   In all that is R exp(x) K0(x) with x = b t0.
// - Decay: sound of Lambert's angles meets the bottom c (2/3) sin(theta_c) / (2 D) times per second, and
//   loses `bounce_loss_db` each time.
// The tail consists of kTailPaths paths that are wholly scattered. It therefore fades, and interferes with
// the packet's own later symbols and with other packets, like any other sound.
//
// Neglected: sound scattered more than once, the tail's own angles (it has those of the strongest path),
// vegetation, fish, bubbles below the surface. A bottom slower than the water has no tail. All scattering
// strengths are uncertain by about 5 dB.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/sea/boundary_reflection.h"

namespace halocline::acoustics {

inline constexpr std::size_t kTailPaths = 16;

struct Reverberation {
  bool enabled = false;
  double bottom_scattering_db = -27;   // 10 log10 mu_b, -80..-5; at -5 everything is scattered
  double surface_scattering_db = -40;  // 10 log10 mu_s, -80..-5 (our choice: a light breeze)
  double bounce_loss_db = 1;           // loss of the tail per bottom bounce, 0.01..100 (our choice)
  bool operator==(const Reverberation&) const = default;
};

// Throws InvalidArgument, naming the field, its value and the permitted range, unless every field is in
// range.
void validate(const Reverberation& reverberation);

// The duct that carries the tail.
struct Duct {
  double depth_m = 0;        // above 0
  double trapped_share = 0;  // q, 0..1
};

// Share q = sin^2 of the critical angle of a bottom under water of 1500 m/s, 0..1; 0 when the bottom is
// slower than the water.
double trapped_share(const FluidBottom& bottom);

// Decay rate b of the tail's power, which falls as exp(-b t), 1/s.
double tail_decay_per_s(const Reverberation& reverberation, const Duct& duct);

// True when a path of with_reverberation() belongs to the tail.
bool is_reverberation(const Arrival& path);

// Returns `paths`, sorted by delay, with the paths of the tail inserted. Without reverberation, bounces or a
// duct they are returned unchanged.
std::vector<Arrival> with_reverberation(const Reverberation& reverberation, const Duct& duct,
                                        std::vector<Arrival> paths);

}  // namespace halocline::acoustics
