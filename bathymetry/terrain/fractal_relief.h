// SPDX-License-Identifier: BSD-3-Clause
// Seeded synthetic relief: fractal terrain, or roughness too fine for charts. It is invented, and reports
// label it so.
//
// Model. The relief is a sum of octaves of gradient noise (Perlin 1985; quintic fade of Perlin 2002) with
// wavelengths halving from `longest_wavelength_m` down to `shortest_wavelength_m`. The amplitude is
// proportional to wavelength^hurst: a self-affine surface of fractal dimension 3 - hurst. The deep-sea floor
// has hurst near 0.9 (Goff and Jordan 1988: fractal dimension 2.1 to 2.2, rms 20 to 200 m at wavelengths of
// kilometres).
//
// A gradient is a random number addressed by (seed, octave, lattice cell), with lattice cells counted from
// the origin of the local frame. So the relief at a point depends only on the point, and any window of it is
// the same at any spacing and in any thread. The rms is that of the ensemble; a window of few wavelengths
// differs from it. Left out: anisotropy, features (channels, boulders), and any likeness to the real place.
#pragma once

#include <cstdint>
#include <vector>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

struct FractalRelief {
  double rms_m = 5;                    // standard deviation of the sum of all octaves; 0 to 5000
  double longest_wavelength_m = 1000;  // at most 1e6
  double shortest_wavelength_m = 50;   // from 0.01; octaves below twice the post spacing would alias
  double hurst = 0.9;                  // 0..1; smaller is rougher at small scale
  std::uint64_t seed = 1;
};

struct ReliefOctave {
  double wavelength_m = 0;
  double amplitude_m = 0;  // the octave's noise is multiplied by this
  std::uint32_t number = 0;
  // Shift of the octave's lattice: noise is 0 at lattice points, which must not coincide.
  double shift_x_m = 0, shift_y_m = 0;
};

// Relief to add to z, m, at the posts of grids of one spacing, wherever they lie: equal to the last bit to
// what add_relief() adds. Coordinates, local NED, are below 1e6 wavelengths. Throws as add_relief() does.
class ReliefFormula {
 public:
  ReliefFormula(const FractalRelief& relief, double spacing_m);
  double operator()(double x_m, double y_m) const;

 private:
  std::uint64_t seed_;
  std::vector<ReliefOctave> octaves_;
};

// Adds the relief to every post that has data. Octaves shorter than two posts are left out. Throws
// InvalidArgument for parameters outside of the ranges of FractalRelief.
void add_relief(const FractalRelief& relief, HeightGrid& grid);

}  // namespace halocline::bathymetry
