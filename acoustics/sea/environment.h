// SPDX-License-Identifier: BSD-3-Clause
// The sea of a link as one value: all parameters of the acoustic models.
//
// Immutable by convention: build it, `validate` it, share it by const reference between threads. One sea
// state applies to the whole scenario, and so does one profile unless there is a field.
#pragma once

#include <memory>

#include "acoustics/sea/absorption.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/profile_drift.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "acoustics/sea/water_load.h"
#include "core/frames.h"
#include "core/tide.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {

// Temperature and salinity of an ocean field at one instant.
struct WaterField {
  std::shared_ptr<const ocean::OceanField> ocean;  // null when there is none
  double time_s = 0;                               // simulation time
  double period_s = 600;                           // span about that instant in which the field is used

  explicit operator bool() const { return ocean != nullptr; }
};

// Parameters of the acoustic models. The defaults are those of the reference figures 4, 6 and 7: global mean
// profile, shipping 0.5, no wind, spreading exponent 1.5.
struct Environment {
  SoundSpeedProfile profile = SoundSpeedProfile::global_mean();
  // Shipping 0..1, wind 0..60 m/s.
  NoiseSources noise;
  double spreading_exponent = 1.5;  // 1 (cylindrical) to 2 (spherical)
  AbsorptionModel absorption_model = AbsorptionModel::kFisherSimmons1977;
  double ph = 8.0;                       // 7 to 9, NBS scale
  double latitude_rad = to_radians(45);  // for depth to pressure; -pi/2..pi/2
  double sea_surface_z_m = 0;            // NED z of the surface, -100..100
  // Water that varies with position, if there is a field. The profile is then that of the world's origin, and
  // only its formula of sound speed is used elsewhere.
  WaterField field = {};
  // Changes of the profile over hours. The profile here is that without them, or with the change of one block
  // in what EnvironmentTimeline (channel_server/propagation) returns; the change holds at all places of a
  // field.
  ProfileDrift drift = {};
  WaterLoad load = {};
  // Ice in the place of waves and bubbles. Under it the wind counts as none.
  IceCover ice = {};
  // Tide about sea_surface_z_m; environments of an instant already include it (environment_timeline.h).
  Tide tide = {};
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const Environment& environment);

// The environment with the field's profile at a place, m north and east, used everywhere; unchanged when
// there is no field.
Environment environment_at(const Environment& environment, double north_m, double east_m);
// Sound speed at a position, m/s; the depth is clamped to the surface and the deepest water.
double sound_speed_at(const Environment& environment, const Vec3& position_ned_m);

// Properties of the water for absorption at `depth_m` below the surface; negative depths count as 0.
AbsorbingWater absorbing_water(const Environment& environment, double depth_m);

// Coefficients of alpha(f) for the environment's model in given water, with what the environment's water
// carries.
AbsorptionSpectrum absorption_spectrum_in(const Environment& environment, const AbsorbingWater& water);
// Coefficients for the water of the profile at a depth.
AbsorptionSpectrum absorption_spectrum_at(const Environment& environment, double depth_m);

}  // namespace halocline::acoustics
