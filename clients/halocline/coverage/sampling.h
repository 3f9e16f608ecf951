// SPDX-License-Identifier: BSD-3-Clause
// Smooth functions at many places from their values at few: the rest by interpolation that is verified on the
// way.
//
// Rule. Between two places that are at most `longest` apart the function is computed at five of the places in
// between, as evenly as they lie. Where the quadratic through the first, the middle and the last misses the
// other two by no more than the tolerance, the rest of the span is given by the quartic through all five;
// else both halves are looked at likewise, in the end place by place. So jumps and kinks are computed where
// they are, but those that leave all five where they were.
//
// Error. Where the function is smooth over a span, below the tolerance by the ratio of quartic to quadratic.
// Pure.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace halocline::clients {

// delivery probability, level dB, delay s (coverage.h).
using Sample = std::array<double, 3>;

// The function at each of `places`, which rise, from calls with some of them; each value within its
// tolerance, 0 or more.
std::vector<Sample> sampled(const std::vector<double>& places, double longest, const Sample& tolerance,
                            const std::function<Sample(double place)>& compute);

}  // namespace halocline::clients
