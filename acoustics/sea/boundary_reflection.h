// SPDX-License-Identifier: BSD-3-Clause
// Reflection of a ray at the bottom and the surface: loss and phase of one bounce.
//
// Bottom: Rayleigh reflection of a plane wave at a fluid half-space (Jensen, Kuperman, Porter and Schmidt
// 2011, equation 1.60), with m the density ratio, n the index of refraction and G the grazing angle:
//   V = (m sin G - sqrt(n^2 - cos^2 G)) / (m sin G + sqrt(n^2 - cos^2 G)).
// Two conventions for a lossy bottom are in use. They differ in second order, which is 0.02 dB a bounce near
// the critical angle:
//   complex wave number  n = (1 + i delta) c_water / c_bottom      APL-UW TR 9407
//   complex speed        n = c_water / (c_bottom (1 - i delta))    ray and mode programs
// delta is the attenuation in dB per wavelength over 40 pi log10(e) = 54.575. Named sediments are those of TR
// 9407 (1994), table 2, with ratios to the water just above. A reported phase acts on an arrival like a
// decrease of its delay: V = |V| e^(-i phase). Left out: shear, layers, roughness and volume scattering of
// the bottom.
//
// Surface: pressure release (V = -1), reduced by wind in one of four published forms. Left out: the spread in
// time and frequency by a moving surface.
//
//   const FluidBottom sand = sediment("MediumSand").value();
//   const double lost_db = bottom_reflection(sand, to_radians(15), 1500).loss_db();
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "acoustics/sea/ice_cover.h"
#include "core/elementary.h"

namespace halocline::acoustics {

// Convention for a lossy bottom (file comment).
enum class BottomLoss { kComplexWaveNumber, kComplexSpeed };

// A fluid half-space. Exactly one of the two speeds is above 0.
struct FluidBottom {
  double density_ratio = 1.845;       // to that of the water, 0.5..10
  double sound_speed_ratio = 1.1782;  // to the water just above, 0.5..5; 0: sound_speed_mps is used
  double sound_speed_mps = 0;         // m/s, 500..7000; 0: sound_speed_ratio is used
  double loss_parameter = 0.01624;    // delta, 0..1
  BottomLoss loss = BottomLoss::kComplexWaveNumber;
  bool operator==(const FluidBottom&) const = default;
};

// Throws InvalidArgument, naming the field, its value and what is allowed, unless every field is in range.
void validate(const FluidBottom& bottom);

// A bottom of a density ratio, a speed and an attenuation in dB per wavelength (0..54), with a complex speed.
FluidBottom fluid_bottom(double density_ratio, double sound_speed_mps, double attenuation_db_per_wavelength);

// The loss parameter delta for an attenuation in dB per wavelength.
double loss_parameter_from_attenuation(double db_per_wavelength);

// A sediment of APL-UW TR 9407 by its name there without spaces ("MediumSand"); empty when unknown.
std::optional<FluidBottom> sediment(std::string_view name);
// Names of the sediments, from rock to clay.
std::vector<std::string_view> sediment_names();

// One bounce: magnitude 0..1 of the pressure reflection coefficient, and the change of phase, rad.
struct Reflection {
  double magnitude = 1;
  double phase_rad = 0;
  double loss_db() const { return -20 * elementary::log10(magnitude); }
};

// Reflection at `grazing_rad` (0..pi/2 to the bottom's own slope) under water of speed `water_speed_mps`.
Reflection bottom_reflection(const FluidBottom& bottom, double grazing_rad, double water_speed_mps);
// Reflection from the sine of the grazing angle, 0..1, which ray tracing has at hand.
Reflection bottom_reflection_at_sine(const FluidBottom& bottom, double sine, double water_speed_mps);
// Magnitude of that reflection.
double bottom_magnitude_at_sine(const FluidBottom& bottom, double sine, double water_speed_mps);

// Models for the loss at the surface.
enum class SurfaceModel {
  kFlat,  // no loss
  // APL-UW TR 9407, part II: absorption by wind-generated bubbles, 1.26e-3 w^1.57 f^0.85 / sin G dB above 6
  // m/s, decreasing as e^(1.2 (w - 6)) below; f in kHz, 10..100 kHz. No loss without wind: the default.
  kAplBubbles,
  // Eckart 1953: the coherent reflection of a Gaussian surface, e^(-Gamma^2 / 2), Gamma = 2 k h sin G, with
  // the rms height of Pierson and Moskowitz, h = 0.22 w^2 / (4 g), and k at 1500 m/s.
  kEckart,
  // Coates 1988, after Beckmann and Spizzichino; the wind is converted to knots. Without wind the loss is
  // still 3.4 dB and more at steep angles.
  kCoates,
  // Jones, Duncan and others 2009 (Proceedings of Acoustics, Adelaide), after Beckmann and Spizzichino.
  kJones,
};

// Names of the models: "flat", "apl-bubbles", "eckart", "coates", "jones". The inverse is empty for other
// names.
std::string_view to_name(SurfaceModel model);
std::optional<SurfaceModel> surface_model_from_name(std::string_view name);

// rms height of a fully developed sea, m, for a wind of `wind_mps` >= 0 (Pierson and Moskowitz).
double rms_wave_height_m(double wind_mps);

// The sea surface for ray tracing.
struct RaySurface {
  SurfaceModel model = SurfaceModel::kAplBubbles;
  double wind_mps = 0;  // 0..60
  IceCover ice = {};    // where it covers, its loss is that of a bounce, whatever the model
  bool operator==(const RaySurface&) const = default;
};

// Loss of one bounce, dB >= 0, at `grazing_rad` in (0, pi/2] and `frequency_hz` > 0.
double surface_loss_db(const RaySurface& surface, double grazing_rad, double frequency_hz);

// Loss of many bounces at one frequency, from the sine of the grazing angle, (0, 1]; common terms are
// computed once. The loss is at most 400 dB.
class SurfaceLoss {
 public:
  SurfaceLoss(const RaySurface& surface, double frequency_hz);
  double db_at_sine(double sine) const;

 private:
  RaySurface surface_;
  double frequency_hz_;
  double bubbles_db_;  // bubble loss at a sine of 1
};

// Factor 0..1 on the pressure of one bounce; the change of phase is always pi.
double surface_magnitude(const RaySurface& surface, double grazing_rad, double frequency_hz);

}  // namespace halocline::acoustics
