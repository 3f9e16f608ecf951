// SPDX-License-Identifier: BSD-3-Clause
// The sea of a link as one value: everything that the acoustic models depend on.
//
// Immutable by convention: build one, `validate` it, share it by const reference between threads. One sea
// state holds for the whole scenario; so does one profile, unless there is a field.
#pragma once

#include <memory>

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/frames.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {

// Temperature and salinity of an ocean field at one instant.
struct WaterField {
  std::shared_ptr<const ocean::OceanField> ocean;  // that has them; null: none
  double time_s = 0;                               // of simulation
  double period_s = 600;                           // the span about that instant in which it holds

  explicit operator bool() const { return ocean != nullptr; }
};

// The defaults are those of the reference figures 4, 6 and 7: global mean profile, s = 0.5, w = 0, k = 1.5.
struct Environment {
  SoundSpeedProfile profile = SoundSpeedProfile::global_mean();
  NoiseSources noise;               // shipping 0..1, wind 0..60 m/s
  double spreading_exponent = 1.5;  // 1 cylindrical to 2 spherical
  AbsorptionModel absorption_model = AbsorptionModel::kFisherSimmons1977;
  double ph = 8.0;                       // 7 to 9, NBS scale
  double latitude_rad = to_radians(45);  // depth to pressure; -pi/2..pi/2
  double sea_surface_z_m = 0;            // NED z of the surface, -100..100
  // By place, where there is one; the profile is then that of the world's origin, and gives the formula of
  // sound speed.
  WaterField field = {};
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Environment& environment);

// The same sea with the field's profile at a place, m north and east, for everywhere; where there is no
// field, the same.
Environment environment_at(const Environment& environment, double north_m, double east_m);
// m/s, at a place of the world; above the surface and below the deepest water, that of these.
double sound_speed_at(const Environment& environment, const Vec3& position_ned_m);

// Water as absorption sees it at `depth_m` below the surface (taken as 0 above it).
AbsorbingWater absorbing_water(const Environment& environment, double depth_m);

// alpha(f) of the environment's model at a depth.
AbsorptionSpectrum absorption_spectrum_at(const Environment& environment, double depth_m);

}  // namespace halocline::acoustics
