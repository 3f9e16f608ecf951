// SPDX-License-Identifier: BSD-3-Clause
// A digest of what this build computes: equal in two processes whose results are the same bytes.
//
// It covers elementary functions, roots, fused and separate products and sums, and rotations, each at
// addressed points (random.h), by the bits of their results. So it shows another C library, SLEEF or Eigen
// where results differ, contraction, excess precision, another mode of rounding, denormals taken as zero; not
// which compiler, processor or level of optimisation it is, as long as they agree.
#pragma once

#include <cstdint>

namespace halocline::bus {

std::uint64_t arithmetic_digest();

}  // namespace halocline::bus
