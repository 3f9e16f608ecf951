// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/boundary_reflection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "acoustics/math/arc_math.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

struct NamedSediment {
  std::string_view name;
  double density_ratio, sound_speed_ratio, loss_parameter;
};

// APL-UW TR 9407, table 2. The table contradicts the report's polynomials in the speed of sandy gravel and
// the density of very coarse sand; the values here are those of the polynomials. Rock and pebbles are
// commonly quoted values from one source.
constexpr std::array<NamedSediment, 22> kSediments = {{
    {"Rock", 2.5, 2.5, 0.01374},
    {"Pebbles", 2.5, 1.8, 0.01374},
    {"SandyGravel", 2.492, 1.337, 0.01705},
    {"VeryCoarseSand", 2.401, 1.3067, 0.01667},
    {"MuddySandyGravel", 2.314, 1.2778, 0.0163},
    {"CoarseSand", 2.231, 1.2503, 0.01638},
    {"GravellyMuddySand", 2.151, 1.2241, 0.01645},
    {"MediumSand", 1.845, 1.1782, 0.01624},
    {"MuddyGravel", 1.615, 1.1396, 0.0161},
    {"FineSand", 1.451, 1.1073, 0.01602},
    {"MuddySand", 1.339, 1.08, 0.01728},
    {"VeryFineSand", 1.268, 1.0568, 0.01875},
    {"ClayeySand", 1.224, 1.0364, 0.02019},
    {"CoarseSilt", 1.195, 1.0179, 0.02158},
    {"SandySilt", 1.169, 0.9999, 0.01261},
    {"MediumSilt", 1.149, 0.9885, 0.00676},
    {"SandyMud", 1.149, 0.9873, 0.00386},
    {"FineSilt", 1.148, 0.9861, 0.00306},
    {"SandyClay", 1.147, 0.9849, 0.00242},
    {"VeryFineSilt", 1.147, 0.9837, 0.00194},
    {"SiltyClay", 1.146, 0.9824, 0.00163},
    {"Clay", 1.145, 0.98, 0.00148},
}};

constexpr std::array kSurfaceModels = {SurfaceModel::kFlat, SurfaceModel::kAplBubbles, SurfaceModel::kEckart,
                                       SurfaceModel::kCoates, SurfaceModel::kJones};

// Attenuation, dB per wavelength, for a loss parameter of 1: 40 pi log10(e).
const double kDecibelsPerLossParameter = 40 * pi * std::numbers::log10e;

constexpr double kGravity = 9.8;          // m/s^2, the value used in the fit of the wave spectrum
constexpr double kWaveModelSpeed = 1500;  // m/s, in Eckart's Gamma
constexpr double kKnotsPerMps = 1.94384;  // the value in common use with Coates's form
constexpr double kMinGrazing = 1e-9;      // rad; the bubble loss diverges as 1 / sin G
constexpr double kMaxLoss = 400;          // dB, limit of the loss of one bounce

// A complex square root with positive imaginary part: the wave in the bottom decays downwards.
struct Root {
  double re, im;
};

Root root_of(double re, double im) {
  const double modulus = std::sqrt(re * re + im * im);
  const double larger = std::sqrt(0.5 * (modulus + std::abs(re)));
  if (larger == 0) return {0, 0};
  const double smaller = im / (2 * larger);
  return re >= 0 ? Root{larger, smaller} : Root{smaller, larger};
}

// The complex reflection coefficient as a quotient.
struct Quotient {
  double numerator_re, numerator_im, denominator_re, denominator_im;
  double magnitude() const {
    return std::sqrt((numerator_re * numerator_re + numerator_im * numerator_im) /
                     (denominator_re * denominator_re + denominator_im * denominator_im));
  }
};

// Rayleigh reflection at a fluid half-space (Jensen and others 2011, equation 1.60), G the grazing angle:
//   V = (m sin G - sqrt(n^2 - cos^2 G)) / (m sin G + sqrt(n^2 - cos^2 G)).
Quotient rayleigh(const FluidBottom& bottom, double sine, double water_speed_mps) {
  const double ratio =
      bottom.sound_speed_ratio > 0 ? bottom.sound_speed_ratio : bottom.sound_speed_mps / water_speed_mps;
  const double delta = bottom.loss_parameter, speed_term = 1 + delta * delta;
  // Index of refraction for a complex wave number, then for a complex speed:
  //   n^2 = (1 + i delta)^2 / ratio^2
  //   n^2 = 1 / (ratio (1 - i delta))^2 = (1 + i delta)^2 / (ratio (1 + delta^2))^2
  const double real = bottom.loss == BottomLoss::kComplexSpeed ? ratio * speed_term : ratio;
  const double n2 = 1 / (real * real);
  const Root below = root_of(n2 * (1 - delta * delta) - (1 - sine * sine), 2 * delta * n2);
  const double above = bottom.density_ratio * sine;
  return {above - below.re, -below.im, above + below.re, below.im};
}

// APL-UW TR 9407 (1994), part II, bubble loss in dB for w >= 6 m/s, f in kHz; for weaker wind the value at 6
// m/s times e^(1.2 (w - 6)).
//   SBL = 1.26e-3 w^1.57 f^0.85 / sin G
double apl_bubble_loss_db(double wind_mps, double grazing_rad, double khz) {
  constexpr double kJoin = 6;  // m/s
  const double steady = 1.26e-3 / elementary::sin(grazing_rad) *
                        elementary::pow(std::max(wind_mps, kJoin), 1.57) * elementary::pow(khz, 0.85);
  // The fit would leave 7e-4 of its value at 6 m/s; without wind there are no bubbles.
  if (wind_mps <= 0) return 0;
  return wind_mps >= kJoin ? steady : steady * elementary::exp(1.2 * (wind_mps - kJoin));
}

// Eckart 1953: the coherent reflection is e^(-Gamma^2 / 2), Gamma = 2 k h sin G.
double eckart_loss_db(double wind_mps, double grazing_rad, double khz) {
  const double wavenumber = 2 * pi * khz_to_hz(khz) / kWaveModelSpeed;
  const double gamma = 2 * wavenumber * rms_wave_height_m(wind_mps) * elementary::sin(grazing_rad);
  return 10 * std::numbers::log10e * gamma * gamma;  // -20 log10 e^(-Gamma^2 / 2)
}

// Coates 1988, after Beckmann and Spizzichino 1963; f in kHz, w in knots, G in degrees:
//   loss = -10 log10((1 + (f / f1)^2) / (1 + (f / f2)^2)) + (1 + (90 - w) / 60) (G / 30)^2,
//   f2 = 378 / w^2, f1 = sqrt(10) f2.
double coates_loss_db(double wind_mps, double grazing_rad, double khz) {
  const double knots = wind_mps * kKnotsPerMps;
  const double f2 = knots > 0 ? 378 / (knots * knots) : 1e30, f1 = std::sqrt(10.0) * f2;  // kHz
  const double low = 10 * elementary::log10((1 + khz * khz / (f1 * f1)) / (1 + khz * khz / (f2 * f2)));
  const double tilt = to_degrees(grazing_rad) / 30;
  return -(low - (1 + (90 - knots) / 60) * tilt * tilt);
}

// Jones, Duncan and others 2009, after Beckmann and Spizzichino 1963; f in Hz, w in m/s, G in rad:
//   loss = -20 log10(0.3 + 0.7 / (1 + 6e-11 w^4 f^2)) - 10 log10(1 - V3),
//   V3 = max(sin(G) / 2, (1 - e^(-a G^2 / 4) / sqrt(pi a G^2)) sin G), at most 0.99,
//   a = 1 / (2 (0.003 + 5.1e-3 w)).
double jones_loss_db(double wind_mps, double grazing_rad, double khz) {
  const double a = 1 / (2 * (0.003 + 5.1e-3 * wind_mps)), theta = grazing_rad;
  const double sine = elementary::sin(theta), hz = khz_to_hz(khz), spread = a * theta * theta;
  const double shadowed = (1 - elementary::exp(-spread / 4) / std::sqrt(pi * spread)) * sine;
  const double v3 = std::min(std::max(sine / 2, shadowed), 0.99);
  const double low = 0.3 + 0.7 / (1 + 6.0e-11 * elementary::pow(wind_mps, 4) * hz * hz);
  return -20 * elementary::log10(low) - 10 * elementary::log10(1 - v3);
}

}  // namespace

void validate(const FluidBottom& bottom) {
  require_in_range(bottom.density_ratio, 0.5, 10, "bottom density ratio");
  require((bottom.sound_speed_ratio > 0) != (bottom.sound_speed_mps > 0),
          "a bottom needs its sound speed either as a ratio or in m/s, not both");
  if (bottom.sound_speed_ratio > 0)
    require_in_range(bottom.sound_speed_ratio, 0.5, 5, "bottom sound speed ratio");
  if (bottom.sound_speed_mps > 0)
    require_in_range(bottom.sound_speed_mps, 500, 7000, "bottom sound speed", "m/s");
  require_in_range(bottom.loss_parameter, 0, 1, "bottom loss parameter");
}

FluidBottom fluid_bottom(double density_ratio, double sound_speed_mps, double attenuation_db_per_wavelength) {
  const FluidBottom bottom{density_ratio, 0, sound_speed_mps,
                           loss_parameter_from_attenuation(attenuation_db_per_wavelength),
                           BottomLoss::kComplexSpeed};
  validate(bottom);
  return bottom;
}

double loss_parameter_from_attenuation(double db_per_wavelength) {
  return db_per_wavelength / kDecibelsPerLossParameter;
}

std::optional<FluidBottom> sediment(std::string_view name) {
  for (const NamedSediment& row : kSediments) {
    if (row.name == name)
      return FluidBottom{row.density_ratio, row.sound_speed_ratio, 0, row.loss_parameter,
                         BottomLoss::kComplexWaveNumber};
  }
  return std::nullopt;
}

std::vector<std::string_view> sediment_names() {
  std::vector<std::string_view> names;
  for (const NamedSediment& row : kSediments) names.push_back(row.name);
  return names;
}

Reflection bottom_reflection(const FluidBottom& bottom, double grazing_rad, double water_speed_mps) {
  return bottom_reflection_at_sine(bottom, elementary::sin(grazing_rad), water_speed_mps);
}

Reflection bottom_reflection_at_sine(const FluidBottom& bottom, double sine, double water_speed_mps) {
  const Quotient v = rayleigh(bottom, sine, water_speed_mps);
  // arg V = arg(numerator conj(denominator)).
  const double re = v.numerator_re * v.denominator_re + v.numerator_im * v.denominator_im;
  const double im = v.numerator_im * v.denominator_re - v.numerator_re * v.denominator_im;
  return {v.magnitude(), -angle_of(im, re)};
}

double bottom_magnitude_at_sine(const FluidBottom& bottom, double sine, double water_speed_mps) {
  return rayleigh(bottom, sine, water_speed_mps).magnitude();
}

std::string_view to_name(SurfaceModel model) {
  switch (model) {
    case SurfaceModel::kFlat:
      return "flat";
    case SurfaceModel::kAplBubbles:
      return "apl-bubbles";
    case SurfaceModel::kEckart:
      return "eckart";
    case SurfaceModel::kCoates:
      return "coates";
    case SurfaceModel::kJones:
      return "jones";
  }
  return "";
}

std::optional<SurfaceModel> surface_model_from_name(std::string_view name) {
  for (const SurfaceModel model : kSurfaceModels) {
    if (to_name(model) == name) return model;
  }
  return std::nullopt;
}

// Pierson and Moskowitz 1964: h = 0.22 w^2 / (4 g).
double rms_wave_height_m(double wind_mps) { return 0.22 * wind_mps * wind_mps / (4 * kGravity); }

double surface_loss_db(const RaySurface& surface, double grazing_rad, double frequency_hz) {
  const double khz = hz_to_khz(frequency_hz), grazing = std::max(grazing_rad, kMinGrazing);
  if (surface.ice.covers()) return ice_loss_db(surface.ice, elementary::sin(grazing));
  switch (surface.model) {
    case SurfaceModel::kFlat:
      return 0;
    case SurfaceModel::kAplBubbles:
      return apl_bubble_loss_db(surface.wind_mps, grazing, khz);
    case SurfaceModel::kEckart:
      return eckart_loss_db(surface.wind_mps, grazing, khz);
    case SurfaceModel::kCoates:
      return coates_loss_db(surface.wind_mps, grazing, khz);
    case SurfaceModel::kJones:
      return jones_loss_db(surface.wind_mps, grazing, khz);
  }
  return 0;
}

SurfaceLoss::SurfaceLoss(const RaySurface& surface, double frequency_hz)
    : surface_(surface),
      frequency_hz_(frequency_hz),
      bubbles_db_(apl_bubble_loss_db(surface.wind_mps, pi / 2, hz_to_khz(frequency_hz))) {}

double SurfaceLoss::db_at_sine(double sine) const {
  if (surface_.ice.covers()) return ice_loss_db(surface_.ice, sine);
  if (surface_.model == SurfaceModel::kFlat) return 0;
  const double loss = surface_.model == SurfaceModel::kAplBubbles
                          ? bubbles_db_ / std::max(sine, kMinGrazing)
                          : surface_loss_db(surface_, elementary::asin(sine), frequency_hz_);
  return std::min(loss, kMaxLoss);
}

double surface_magnitude(const RaySurface& surface, double grazing_rad, double frequency_hz) {
  if (surface.ice.covers())
    return elementary::exp10(-ice_loss_db(surface.ice, elementary::sin(grazing_rad)) / 20);
  if (surface.model == SurfaceModel::kFlat) return 1;
  if (surface.model == SurfaceModel::kAplBubbles && surface.wind_mps <= 0) return 1;
  return elementary::exp10(-std::min(surface_loss_db(surface, grazing_rad, frequency_hz), kMaxLoss) / 20);
}

}  // namespace halocline::acoustics
