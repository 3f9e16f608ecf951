// SPDX-License-Identifier: BSD-3-Clause
// The tail that rough boundaries leave behind every packet: reverberation of its own sound at the receiver.
//
// Model, for water of depth D over a bottom of critical angle theta_c:
// - Lambert's law: a bounce scatters sound that comes at the grazing angle theta_i into theta_s by mu
//   sin(theta_i) sin(theta_s) a unit of area and solid angle, 10 log10 mu = -27 dB for bottoms (Mackenzie
//   1961; Urick 1983, chapter 8). Over all directions that is the share pi mu of the incident power, whatever
//   its angle; of it q = sin^2(theta_c) stays below the critical angle (acoustics/fading/path_fading.h).
// - A path of power P and delay t0 with N_b and N_s bounces at bottom and surface so feeds the tail by
//   R = P q (N_b pi mu_b + N_s pi mu_s). Scattered evenly over all azimuths of a duct in which sound spreads
//   cylindrically, once, it comes from the ellipses about both ends:
//     dI/dt = R exp(-b (t - t0)) / sqrt(t^2 - t0^2),  t > t0
//   (in elliptic coordinates dA / (R1 R2) = du dv and t = t0 cosh u), all together R exp(x) K0(x), x = b t0.
// - Decay: sound of Lambert's angles meets the bottom c (2/3) sin(theta_c) / (2 D) times a second, and loses
//   the stated decibels each time.
// The tail is given as kTailPaths paths that are all scattered, so that it fades, interferes with the
// packet's own later symbols and with other packets as any sound does.
// Left out: sound scattered more than once, the tail's own angles (it takes those of the strongest path),
// vegetation, fish, bubbles below the surface. Bottoms slower than the water hold no tail. All scattering
// strengths are of order 5 dB uncertain.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/sound_path.h"

namespace halocline::acoustics {

inline constexpr std::size_t kTailPaths = 16;

struct Reverberation {
  bool enabled = false;
  double bottom_scattering_db = -27;   // 10 log10 mu_b, -80..-5; -5 scatters all
  double surface_scattering_db = -40;  // 10 log10 mu_s, likewise (our choice: a light breeze)
  double bounce_loss_db = 1;           // of the tail at each bottom bounce, 0.01..100 (our choice)
  bool operator==(const Reverberation&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Reverberation& reverberation);

// The water that holds the tail.
struct Duct {
  double depth_m = 0;        // above 0
  double trapped_share = 0;  // q, 0..1
};

// exp(-b t) of the tail's power: b, 1/s.
double tail_decay_per_s(const Reverberation& reverberation, const Duct& duct);

// Whether a path of with_reverberation() is one of the tail.
bool is_reverberation(const SoundPath& path);

// `paths` by delay, and the tail among them. Without reverberation, bounces or a duct, as they are.
std::vector<SoundPath> with_reverberation(const Reverberation& reverberation, const Duct& duct,
                                          std::vector<SoundPath> paths);

}  // namespace halocline::acoustics
