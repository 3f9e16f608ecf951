// SPDX-License-Identifier: BSD-3-Clause
// Digest of the numerical results of this build: equal in two processes that compute the same bytes.
//
// It covers elementary functions, roots, products and sums (fused and separate), and rotations, each at
// counter-based random points (random.h), by the bits of their results. It thus detects another C library,
// SLEEF or Eigen if results differ, contraction of expressions, excess precision, another rounding mode, and
// flushing of denormals to zero. Compiler, processor and optimisation level may differ as long as the results
// agree.
#pragma once

#include <cstdint>

namespace halocline::bus {

std::uint64_t arithmetic_digest();

}  // namespace halocline::bus
