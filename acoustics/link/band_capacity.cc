// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/band_capacity.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "core/elementary.h"
#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

constexpr std::size_t kChunk = 64;  // nodes whose terms are kept at a time
constexpr double kMaxNepers = 700;  // exp(-700) is a normal number
using Chunk = std::array<double, kChunk>;

// Mean absorption of the nodes from `first` on, as computed by DepthMeans::mean().
[[gnu::always_inline]] inline void set_means(const BandLeg& leg, std::size_t first, std::size_t count,
                                             Chunk& means) {
  const DepthMeans& water = *leg.absorption;
  const std::size_t stride = water.count();
  const double *above = water.terms(leg.upper.cell) + first, *below = water.terms(leg.lower.cell) + first;
  const double x_above = leg.upper.x, x_below = leg.lower.x;
  if (leg.upper.cell == leg.lower.cell) {
    for (std::size_t i = 0; i < count; ++i) means[i] = mean_within_cell(above + i, stride, x_above, x_below);
    return;
  }
  const double *from = water.integral_to(leg.upper.cell + 1) + first,
               *to = water.integral_to(leg.lower.cell) + first;
  const double head_m = water.bottom_m(leg.upper.cell) - leg.upper.depth_m;
  const double tail_m = leg.lower.depth_m - water.top_m(leg.lower.cell);
  const double per_m = 1 / (leg.lower.depth_m - leg.upper.depth_m);
  for (std::size_t i = 0; i < count; ++i) {
    const double head = head_m * mean_within_cell(above + i, stride, x_above, 1);
    const double tail = tail_m * mean_within_cell(below + i, stride, -1, x_below);
    means[i] = (head + (to[i] - from[i]) + tail) * per_m;
  }
}

// C = log2(e) * sum of w ln(1 + u exp(-(loss + slope mean))), with four partial sums in a fixed order.
[[gnu::always_inline]] inline double capacity(const BandNodes& nodes, const BandLeg& leg) {
  constexpr std::size_t kSums = 4;
  std::array<double, kSums> sums{};
  const std::size_t all = nodes.weight_hz.size();
  const double loss = leg.loss_nepers, slope = leg.nepers_per_db_per_km;
  for (std::size_t first = 0; first < all; first += kChunk) {
    // The count is a multiple of the vector width; this form lets the compiler know it.
    const std::size_t count =
        std::min(all - first, kChunk) / BandNodes::kNodesTogether * BandNodes::kNodesTogether;
    const double *weight = nodes.weight_hz.data() + first, *unit = nodes.unit_ratio.data() + first;
    Chunk terms;
    set_means(leg, first, count, terms);
    for (std::size_t i = 0; i < count; ++i) {
      const double lost = loss + slope * terms[i], held = lost < kMaxNepers ? lost : kMaxNepers;
      terms[i] = weight[i] * elementary::log1p_within(unit[i] * elementary::exp_within(-held));
    }
    for (std::size_t i = 0; i < count; i += kSums) {
      for (std::size_t j = 0; j < kSums; ++j) sums[j] += terms[i + j];
    }
  }
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) * std::numbers::log2e;
}

double baseline_capacity(const BandNodes& nodes, const BandLeg& leg) { return capacity(nodes, leg); }

#if HALOCLINE_HAS_X86_VECTORS
[[gnu::target("avx2")]] double avx2_capacity(const BandNodes& nodes, const BandLeg& leg) {
  return capacity(nodes, leg);
}
[[gnu::target("avx512f,avx512dq,avx512vl")]] double avx512_capacity(const BandNodes& nodes,
                                                                    const BandLeg& leg) {
  return capacity(nodes, leg);
}
#endif

}  // namespace

std::vector<VectorInstructions> vector_instructions() {
  std::vector<VectorInstructions> known{VectorInstructions::kBaseline};
#if HALOCLINE_HAS_X86_VECTORS
  if (__builtin_cpu_supports("avx2") != 0) known.push_back(VectorInstructions::kAvx2);
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0) {
    known.push_back(VectorInstructions::kAvx512);
  }
#endif
  return known;
}

BandCapacity band_capacity(VectorInstructions instructions) {
#if HALOCLINE_HAS_X86_VECTORS
  if (instructions == VectorInstructions::kAvx512) return avx512_capacity;
  if (instructions == VectorInstructions::kAvx2) return avx2_capacity;
#endif
  (void)instructions;
  return baseline_capacity;
}

}  // namespace halocline::acoustics
