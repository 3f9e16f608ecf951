// SPDX-License-Identifier: BSD-3-Clause
// Speed of sound of TEOS-10 from the 75-term polynomial of specific volume (Roquet et al. 2015, appendix A).
#include <cmath>

#include "acoustics/sea/sound_speed.h"

namespace halocline::acoustics {
namespace {

// One term v x^salinity y^temperature z^pressure of specific volume, m^3/kg.
struct Term {
  int temperature, salinity, pressure;
  double v;
};

constexpr Term kSpecificVolume[] = {
    {0, 0, 0, 1.0769995862e-3},  {0, 0, 1, -6.0799143809e-5}, {0, 0, 2, 9.9856169219e-6},
    {0, 0, 3, -1.1309361437e-6}, {0, 0, 4, 1.0531153080e-7},  {0, 0, 5, -1.2647261286e-8},
    {0, 0, 6, 1.9613503930e-9},  {0, 1, 0, -3.1038981976e-4}, {0, 1, 1, 2.4262468747e-5},
    {0, 1, 2, -5.8484432984e-7}, {0, 1, 3, 3.6310188515e-7},  {0, 1, 4, -1.1147125423e-7},
    {0, 2, 0, 6.6928067038e-4},  {0, 2, 1, -3.4792460974e-5}, {0, 2, 2, -4.8122251597e-6},
    {0, 2, 3, 1.6746303780e-8},  {0, 3, 0, -8.5047933937e-4}, {0, 3, 1, 3.7470777305e-5},
    {0, 3, 2, 4.9263106998e-6},  {0, 4, 0, 5.8086069943e-4},  {0, 4, 1, -1.7322218612e-5},
    {0, 4, 2, -1.7811974727e-6}, {0, 5, 0, -2.1092370507e-4}, {0, 5, 1, 3.0927427253e-6},
    {0, 6, 0, 3.1932457305e-5},  {1, 0, 0, -1.5649734675e-5}, {1, 0, 1, 1.8505765429e-5},
    {1, 0, 2, -1.1736386731e-6}, {1, 0, 3, -3.6527006553e-7}, {1, 0, 4, 3.1454099902e-7},
    {1, 1, 0, 3.5009599764e-5},  {1, 1, 1, -9.5677088156e-6}, {1, 1, 2, -5.5699154557e-6},
    {1, 1, 3, -2.7295696237e-7}, {1, 2, 0, -4.3592678561e-5}, {1, 2, 1, 1.1100834765e-5},
    {1, 2, 2, 5.4620748834e-6},  {1, 3, 0, 3.4532461828e-5},  {1, 3, 1, -9.8447117844e-6},
    {1, 3, 2, -1.3544185627e-6}, {1, 4, 0, -1.1959409788e-5}, {1, 4, 1, 2.5909225260e-6},
    {1, 5, 0, 1.3864594581e-6},  {2, 0, 0, 2.7762106484e-5},  {2, 0, 1, -1.1716606853e-5},
    {2, 0, 2, 2.1305028740e-6},  {2, 0, 3, 2.8695905159e-7},  {2, 1, 0, -3.7435842344e-5},
    {2, 1, 1, -2.3678308361e-7}, {2, 1, 2, 3.9137387080e-7},  {2, 2, 0, 3.5907822760e-5},
    {2, 2, 1, 2.9283346295e-6},  {2, 2, 2, -6.5731104067e-7}, {2, 3, 0, -1.8698584187e-5},
    {2, 3, 1, -4.8826139200e-7}, {2, 4, 0, 3.8595339244e-6},  {3, 0, 0, -1.6521159259e-5},
    {3, 0, 1, 7.9279656173e-6},  {3, 0, 2, -4.6132540037e-7}, {3, 1, 0, 2.4141479483e-5},
    {3, 1, 1, -3.4558773655e-6}, {3, 1, 2, 7.7618888092e-9},  {3, 2, 0, -1.4353633048e-5},
    {3, 2, 1, 3.1655306078e-7},  {3, 3, 0, 2.2863324556e-6},  {4, 0, 0, 6.9111322702e-6},
    {4, 0, 1, -3.4102187482e-6}, {4, 0, 2, -6.3352916514e-8}, {4, 1, 0, -8.7595873154e-6},
    {4, 1, 1, 1.2956717783e-6},  {4, 2, 0, 4.3703680598e-6},  {5, 0, 0, -8.0539615540e-7},
    {5, 0, 1, 5.0736766814e-7},  {5, 1, 0, -3.3052758900e-7}, {6, 0, 0, 2.0543094268e-7},
};
static_assert(std::size(kSpecificVolume) == 75);

constexpr int kHighestPower = 6;
constexpr double kReferenceSalinity = 35.16504;                  // g/kg, sea water of practical salinity 35
constexpr double kSalinityScale = 40 * kReferenceSalinity / 35;  // g/kg, practical salinity 40
constexpr double kSalinityOffset = 24;    // g/kg, keeps the square root smooth in fresh water
constexpr double kTemperatureScale = 40;  // degC
constexpr double kPressureScale = 1e4;    // dbar
constexpr double kPascalPerDbar = 1e4;

struct Powers {
  double of[kHighestPower + 1];
  explicit Powers(double x) {
    of[0] = 1;
    for (int i = 1; i <= kHighestPower; ++i) of[i] = of[i - 1] * x;
  }
};

}  // namespace

double teos10_75_term(double absolute_salinity_g_per_kg, double conservative_temperature_degc,
                      double pressure_dbar) {
  // c^2 = -v^2 / (dv/dp) with
  //   v = sum of v_ijk x^i y^j z^k,  x = sqrt((S + 24) / S_u),  y = T / 40,  z = p / 10^4 dbar.
  const Powers x(std::sqrt((absolute_salinity_g_per_kg + kSalinityOffset) / kSalinityScale));
  const Powers y(conservative_temperature_degc / kTemperatureScale);
  const Powers z(pressure_dbar / kPressureScale);
  double v = 0, dv_dz = 0;
  for (const Term& term : kSpecificVolume) {
    const double of_water = term.v * x.of[term.salinity] * y.of[term.temperature];
    v += of_water * z.of[term.pressure];
    if (term.pressure > 0) dv_dz += of_water * term.pressure * z.of[term.pressure - 1];
  }
  const double dv_dpressure = dv_dz / (kPressureScale * kPascalPerDbar);  // m^3/kg/Pa
  return std::sqrt(-v * v / dv_dpressure);
}

}  // namespace halocline::acoustics
