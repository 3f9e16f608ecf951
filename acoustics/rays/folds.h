// Levels of the two rays of a fold: a caustic, on the lit side of which two rays of one smooth family pass.
//
// Model: towards the caustic the two come nearer to each other in time, by dt, and the amplitude that ray theory gives
// each of them grows as (omega dt)^(-1/6) without bound. The field is that of Airy's function, whose greatest value,
// Ai(-1.0188) = 0.5357, is the amplitude of a ray where omega dt = (2/3) 0.555^3 / 4 (Jensen and others 2011, section
// 3.3.5; Brekhovskikh and Godin 1999, chapter 3). Nearer to the caustic each keeps that amplitude, so that levels go
// with the wavelength and stay finite. A ray whose partner is missing, because its family ends before the caustic (at a
// kink of the water, at an edge of the bottom), keeps the level of its tube.
#pragma once

#include <cstdint>
#include <vector>

#include "acoustics/rays/arrivals.h"

namespace halocline::acoustics {

// Lowers the amplitudes of the rays of folds. `families` of all paths: rays between whose launch angles range and depth
// of arrival change smoothly share a number. The rays of a fold are next to each other in launch angle, and one of them
// has touched one caustic more.
void bound_folds(const std::vector<std::uint64_t>& families, double frequency_hz,
                 std::vector<Arrival>& paths);

// A number for `family` continued by `what`.
constexpr std::uint64_t continued_family(std::uint64_t family, std::uint64_t what) {
  // Steps of SplitMix64 (Steele and others 2014): families are told apart by all that was mixed in.
  family = (family ^ (what + 1)) * 0x9E3779B97F4A7C15ULL;
  return family ^ (family >> 29);
}

}  // namespace halocline::acoustics
