// SPDX-License-Identifier: BSD-3-Clause
// Absorption by what the water carries: suspended mineral particles, and plants.
//
// Particles (Urick 1948, JASA 20, 283): nepers of power a metre
//   2 alpha = phi [k (s - 1)^2 q / (q^2 + (s + d)^2) + k^4 a^3 / 3]
//   b = sqrt(omega / (2 nu)),  q = 9 / (4 b a) (1 + 1 / (b a)),  d = 1/2 + 9 / (4 b a)
// with the share phi of the volume, the wave number k, the radius a, the density s of quartz over that of
// the water (2.65) and the viscosity nu of the water (1.3e-6 m^2/s); the first term is drag in the water
// that moves past a particle, the second scattering. Spheres of one size, far apart: up to some 10 kg/m^3,
// ka below 1. The wave number is that in water of 1500 m/s. Plants take a fixed number of decibels a
// kilometre at all frequencies (a meadow takes tens of them: Lee et al. 2019, JASA 146, EL335).
//
//   const double db_per_km = WaterLoad{.particles_kg_m3 = 0.2, .particle_radius_m = 3e-6}.db_per_km(25e3);
//       // 7.5
#pragma once

namespace halocline::acoustics {

// The load of the water, equal everywhere; none by default.
struct WaterLoad {
  double particles_kg_m3 = 0;       // mass of particles in the water, 0..100
  double particle_radius_m = 3e-6;  // 1e-7..1e-3
  double plants_db_per_km = 0;      // 0..1000

  bool is_none() const { return particles_kg_m3 == 0 && plants_db_per_km == 0; }
  // Absorption beside that of clear water, dB/km, at `frequency_hz` > 0; at least 0.
  double db_per_km(double frequency_hz) const;
};

}  // namespace halocline::acoustics
