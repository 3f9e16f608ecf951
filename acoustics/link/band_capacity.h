// SPDX-License-Identifier: BSD-3-Clause
// Capacity of a straight leg from the nodes of a band: the innermost loop of acoustics/link/link_kernel.h.
//
// With the nodes of the band as the points of a quadrature, the capacity in bit/s is
//   C = sum over nodes of  w log2(1 + u exp(-(loss + nepers mean))),
// w the weight of the node, Hz, u the signal-to-noise ratio without any loss, loss the frequency-independent
// loss in nepers, mean the mean absorption along the leg, dB/km, and nepers the nepers over the leg for each
// dB/km.
// One function body is compiled for each set of vector instructions. The nodes are the lanes of a vector,
// multiplication and addition are never fused, and the order of summation is fixed: all sets give the same
// bits.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/math/depth_means.h"

namespace halocline::acoustics {

// Sets of vector instructions; kBaseline is the one that the build assumes.
enum class VectorInstructions { kBaseline, kAvx2, kAvx512 };
// The sets that this processor supports, the widest last.
std::vector<VectorInstructions> vector_instructions();

// Nodes of a band: squared frequencies, kHz^2, weights, Hz, and signal-to-noise ratios without loss. All
// vectors have one size, a multiple of kNodesTogether.
struct BandNodes {
  static constexpr std::size_t kNodesTogether = 8;
  std::vector<double> khz_squared, weight_hz, unit_ratio;
};

// A leg between two depths, with the loss by its length and spreading.
struct BandLeg {
  const DepthMeans* absorption;  // dB/km, one property for each node
  DepthMeans::Place upper, lower;
  double loss_nepers;           // nepers of power, equal at all frequencies; above -700
  double nepers_per_db_per_km;  // nepers of power per dB/km, 0 or more
};

// Computes the capacity of a leg, bit/s; losses above 700 nepers count as 700.
using BandCapacity = double (*)(const BandNodes& nodes, const BandLeg& leg);
// The function for `instructions`, which must be among vector_instructions().
BandCapacity band_capacity(VectorInstructions instructions);

}  // namespace halocline::acoustics
