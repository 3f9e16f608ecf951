// SPDX-License-Identifier: BSD-3-Clause
// Capacity of a straight leg over the nodes of a band: the innermost loop of acoustics/link/link_kernel.h.
//
// C = sum of w log2(1 + u exp(-(loss + nepers mean))) over the nodes: weight w in Hz, u the signal-to-noise
// ratio of a link that loses nothing, mean the absorption along the leg in dB/km.
// One body is compiled for each set of vector instructions. Nodes are its lanes, multiplication and addition
// are never fused, and the sum has an order of its own: all sets give the same bits.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/math/depth_means.h"

namespace halocline::acoustics {

enum class VectorInstructions { kBaseline, kAvx2, kAvx512 };  // the first: what the build assumes
// What this processor has, the widest last.
std::vector<VectorInstructions> vector_instructions();

// Of a band; all have one size, a multiple of kNodesTogether.
struct BandNodes {
  static constexpr std::size_t kNodesTogether = 8;
  std::vector<double> khz_squared, weight_hz, unit_ratio;
};

// A leg between two depths, and what its length and spreading lose.
struct BandLeg {
  const DepthMeans* absorption;  // dB/km, a property a node
  DepthMeans::Place upper, lower;
  double loss_nepers;           // of power; the same at all frequencies; above -700
  double nepers_per_db_per_km;  // of power, 0 and up
};

// bit/s; losses beyond 700 nepers count as 700.
using BandCapacity = double (*)(const BandNodes& nodes, const BandLeg& leg);
// `instructions` has to be among vector_instructions().
BandCapacity band_capacity(VectorInstructions instructions);

}  // namespace halocline::acoustics
