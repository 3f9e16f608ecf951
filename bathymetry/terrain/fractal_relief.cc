// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/fractal_relief.h"

#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"
#include "core/huge_page_vector.h"
#include "core/random.h"

namespace halocline::bathymetry {
namespace {

// Mean square of gradient noise with unit gradients of random direction. With w = 1 - fade(t),
//
//   mean square = 4 A B
//   A = integral of w^2 over 0..1 = 181/462
//   B = integral of w^2 t^2 over 0..1 = 535/18018
constexpr double kNoiseMeanSquare = 4 * (181.0 / 462.0) * (535.0 / 18018.0);

struct Gradient {
  double x = 0, y = 0;
};

using Octave = ReliefOctave;

// Quintic fade of Perlin 2002: 6 t^5 - 15 t^4 + 10 t^3.
double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

Gradient gradient_at(std::uint64_t seed, std::uint32_t octave, std::int64_t i, std::int64_t j) {
  const std::uint64_t cell =
      static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 | static_cast<std::uint32_t>(j);
  const double angle =
      2 * std::numbers::pi *
      uniform_at({.seed = seed, .purpose = purpose_of("relief"), .who = octave, .which = cell});
  return {elementary::cos(angle), elementary::sin(angle)};
}

// Returns the noise at the fractions (u, v) of a lattice cell with these gradients g at its corners: the
// products g . (distance from the corner), interpolated between the corners with weights fade(u) and fade(v).
double noise(const Gradient& g00, const Gradient& g10, const Gradient& g01, const Gradient& g11, double u,
             double v) {
  const double n00 = g00.x * u + g00.y * v, n10 = g10.x * (u - 1) + g10.y * v;
  const double n01 = g01.x * u + g01.y * (v - 1), n11 = g11.x * (u - 1) + g11.y * (v - 1);
  const double fu = fade(u), low = n00 + (n10 - n00) * fu, high = n01 + (n11 - n01) * fu;
  return low + (high - low) * fade(v);
}

// Returns octaves of halving wavelengths. Amplitudes are scaled so that their variances sum to rms^2.
std::vector<Octave> octaves_of(const FractalRelief& relief) {
  std::vector<Octave> octaves;
  double variance = 0;
  double wavelength = relief.longest_wavelength_m;
  for (std::uint32_t n = 0; n == 0 || wavelength >= relief.shortest_wavelength_m; ++n, wavelength /= 2) {
    const double amplitude = elementary::pow(wavelength / relief.longest_wavelength_m, relief.hurst);
    variance += amplitude * amplitude * kNoiseMeanSquare;
    const DrawAddress shift{.seed = relief.seed, .purpose = purpose_of("relief-shift"), .who = n};
    octaves.push_back({wavelength, amplitude, n, wavelength * uniform_at(shift),
                       wavelength * uniform_at({shift.seed, shift.purpose, shift.who, 1})});
  }
  for (Octave& octave : octaves) octave.amplitude_m *= relief.rms_m / std::sqrt(variance);
  return octaves;
}

void require_possible(const FractalRelief& relief) {
  require_in_range(relief.rms_m, 0, 5000, "rms_m of the relief", "m");
  require_in_range(relief.longest_wavelength_m, 0.01, 1e6, "longest_wavelength_m of the relief", "m");
  require_in_range(relief.shortest_wavelength_m, 0.01, relief.longest_wavelength_m,
                   "shortest_wavelength_m of the relief", "m");
  require_in_range(relief.hurst, 0, 1, "hurst of the relief");
}

// Lattice cell of a coordinate, and the fraction within it.
struct LatticePlace {
  std::int64_t cell;
  double fraction;
};
LatticePlace lattice_place(double metres, double wavelength_m) {
  const double place = metres / wavelength_m, cell = std::floor(place);
  return {static_cast<std::int64_t>(cell), place - cell};
}
LatticePlace place_x(const Octave& octave, double x_m) {
  return lattice_place(x_m + octave.shift_x_m, octave.wavelength_m);
}
LatticePlace place_y(const Octave& octave, double y_m) {
  return lattice_place(y_m + octave.shift_y_m, octave.wavelength_m);
}

// Gradients of all lattice corners that a grid needs, drawn once.
class GradientTable {
 public:
  GradientTable(std::uint64_t seed, const Octave& octave, const GridGeometry& g)
      : first_i_(place_x(octave, g.first_x_m).cell),
        first_j_(place_y(octave, g.first_y_m).cell),
        columns_(place_y(octave, g.last_y_m()).cell + 2 - first_j_) {
    const std::int64_t rows = place_x(octave, g.last_x_m()).cell + 2 - first_i_;
    gradients_.reserve(static_cast<std::size_t>(rows * columns_));
    for (std::int64_t i = 0; i < rows; ++i) {
      for (std::int64_t j = 0; j < columns_; ++j) {
        gradients_.push_back(gradient_at(seed, octave.number, first_i_ + i, first_j_ + j));
      }
    }
  }
  const Gradient& at(std::int64_t i, std::int64_t j) const {
    return gradients_[static_cast<std::size_t>((i - first_i_) * columns_ + (j - first_j_))];
  }

 private:
  std::int64_t first_i_, first_j_, columns_;
  std::vector<Gradient> gradients_;
};

void add_octave(const Octave& octave, std::uint64_t seed, const GridGeometry& g, std::vector<double>& sum) {
  const GradientTable table(seed, octave, g);
  std::size_t n = 0;
  for (int i = 0; i < g.posts_x; ++i) {
    const LatticePlace x = place_x(octave, g.x_at(i));
    for (int j = 0; j < g.posts_y; ++j, ++n) {
      const LatticePlace y = place_y(octave, g.y_at(j));
      sum[n] += octave.amplitude_m * noise(table.at(x.cell, y.cell), table.at(x.cell + 1, y.cell),
                                           table.at(x.cell, y.cell + 1), table.at(x.cell + 1, y.cell + 1),
                                           x.fraction, y.fraction);
    }
  }
}

}  // namespace

ReliefFormula::ReliefFormula(const FractalRelief& relief, double spacing_m) : seed_(relief.seed) {
  require_possible(relief);
  octaves_ = octaves_of(relief);
  std::erase_if(octaves_, [&](const Octave& octave) { return octave.wavelength_m < 2 * spacing_m; });
}

double ReliefFormula::operator()(double x_m, double y_m) const {
  double sum = 0;
  for (const Octave& octave : octaves_) {
    const LatticePlace x = place_x(octave, x_m), y = place_y(octave, y_m);
    const auto corner = [&](int di, int dj) {
      return gradient_at(seed_, octave.number, x.cell + di, y.cell + dj);
    };
    sum += octave.amplitude_m *
           noise(corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1), x.fraction, y.fraction);
  }
  return sum;
}

void add_relief(const FractalRelief& relief, HeightGrid& grid) {
  require_possible(relief);
  std::vector<double> sum(grid.posts().size(), 0.0);
  for (const Octave& octave : octaves_of(relief)) {
    if (octave.wavelength_m < 2 * grid.geometry().spacing_m) break;
    add_octave(octave, relief.seed, grid.geometry(), sum);
  }
  HugePageVector<float>& posts = grid.posts_for_editing();
  for (std::size_t n = 0; n < posts.size(); ++n) posts[n] = static_cast<float>(posts[n] + sum[n]);
}

}  // namespace halocline::bathymetry
