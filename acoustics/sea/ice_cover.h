// SPDX-License-Identifier: BSD-3-Clause
// Sea ice as a boundary of the water: the loss of one bounce under it, and of sound that passes its keels.
//
// Model. Under ice the surface is this boundary in the place of waves and bubbles. A bounce loses
//
//   loss_db + loss_per_sine_db sin(grazing angle) dB
//
// to the ice, with the phase of a pressure-release face. Its roughness scatters by the Rayleigh parameter, as
// waves do, and turns sound by facets of the slope `slope`. Keels stand in the upper part of the water: each
// takes the share draft / depth of the power that passes. All numbers are choices, set once against the
// ranges of modems under the ice of Thule (3.5 kHz, 20 to 35 km) and Prudhoe Bay (10 kHz, 1.5 to 5.6 km).
// Excursions of 15 dB under ice that looks flat (Verrall and Ganton 1977) are the scattering. Left out: waves
// within the ice, its change with time, and the place of single keels.
#pragma once

namespace halocline::acoustics {

enum class IceKind {
  kNone,
  kFast,  // stands still: no Doppler spread by the surface, and fading that lives for hours
  kPack,  // drifts: fading as in open water, without waves
};

struct IceCover {
  IceKind kind = IceKind::kNone;
  double roughness_m = 0.2;      // rms height of the lower face, m, 0..5
  double slope = 0.08;           // rms slope of its facets in a plane, 0..1
  double loss_db = 0.8;          // of a bounce, dB, 0..20
  double loss_per_sine_db = 10;  // additional loss of a bounce times the sine of the grazing angle, dB, 0..50
  double keels_per_km = 0;       // along a path, 0..100
  double keel_draft_m = 2;       // below the surface, m, 0..60

  bool covers() const { return kind != IceKind::kNone; }
  bool operator==(const IceCover&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const IceCover& ice);

// Loss of one bounce under the ice, dB, at the sine of the grazing angle, 0..1.
double ice_loss_db(const IceCover& ice, double sine);

// Loss by keels along a path in water `depth_m` deep, dB/km; 0 for an unknown depth of 0:
//   -10 log10(1 - draft / depth) keels_per_km
// A keel takes at most 99 % of the power. 0 without ice.
double keel_loss_db_per_km(const IceCover& ice, double depth_m);

}  // namespace halocline::acoustics
