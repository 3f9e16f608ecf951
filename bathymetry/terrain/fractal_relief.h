// SPDX-License-Identifier: BSD-3-Clause
// Seeded synthetic relief: fractal terrain, or the roughness that charts are too coarse to hold. It is
// invented, and reports label it so.
//
// Model: a sum of octaves of gradient noise (Perlin 1985; quintic fade of Perlin 2002), wavelengths halving
// from `longest_wavelength_m` down to `shortest_wavelength_m`. Amplitude goes with wavelength^hurst: a
// self-affine surface of fractal dimension 3 - hurst; the deep-sea floor has hurst near 0.9 (Goff and Jordan
// 1988: fractal dimension 2.1 to 2.2, rms 20 to 200 m at wavelengths of kilometres). A gradient is a draw
// addressed by (seed, octave, lattice cell), lattice cells being counted from the origin of the local frame:
// the relief at a point depends on the point alone, so any window of it, at any spacing, by any thread, is
// the same. The rms is of the ensemble; a window of few wavelengths differs from it. Left out: anisotropy,
// features (channels, boulders), any likeness to the real place.
#pragma once

#include <cstdint>
#include <vector>

#include "bathymetry/terrain/height_grid.h"

namespace halocline::bathymetry {

struct FractalRelief {
  double rms_m = 5;                    // standard deviation of the sum of all octaves; 0 to 5000
  double longest_wavelength_m = 1000;  // at most 1e6
  double shortest_wavelength_m = 50;   // from 0.01; octaves below twice the post spacing would only alias
  double hurst = 0.9;                  // 0..1; smaller is rougher at small scale
  std::uint64_t seed = 1;
};

// One octave of the sum.
struct ReliefOctave {
  double wavelength_m = 0;
  double amplitude_m = 0;  // the octave's noise is multiplied by this
  std::uint32_t number = 0;
  // Of its lattice: noise is 0 at lattice points, which must not coincide.
  double shift_x_m = 0, shift_y_m = 0;
};

// The relief at (x, y), local NED, |coordinate| below 1e6 wavelengths: metres to add to z. Slow: for single
// points.
double relief_at(const FractalRelief& relief, double x_m, double y_m);

// The relief at the posts of grids of one spacing, wherever they lie: to the last bit what add_relief() adds
// to them. Throws as that does.
class ReliefFormula {
 public:
  ReliefFormula(const FractalRelief& relief, double spacing_m);
  double operator()(double x_m, double y_m) const;

 private:
  std::uint64_t seed_;
  std::vector<ReliefOctave> octaves_;
};

// Adds the relief to every post that has data. Octaves shorter than two posts are left out. Throws
// InvalidArgument for parameters outside of what FractalRelief states.
void add_relief(const FractalRelief& relief, HeightGrid& grid);

}  // namespace halocline::bathymetry
