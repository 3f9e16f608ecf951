// SPDX-License-Identifier: BSD-3-Clause
// Sampling of a smooth function at many places from few evaluations: the other values are interpolated where
// that is verified.
//
// Rule. Within a span of places no longer than `longest` the function is computed at five places spread as
// evenly as possible. If the quadratic through the first, the middle and the last of them reproduces the
// other two within the tolerance, the remaining places of the span are interpolated by the quartic through
// all five; otherwise both halves are treated in the same way, down to single places. Jumps and kinks are
// thus computed where they are, unless they leave all five values unchanged.
//
// Error. For a function that is smooth within the span, the tolerance times the ratio of the quartic's error
// to the quadratic's. Pure.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace halocline::clients {

// Values of the function: delivery probability, level in dB, delay in s, SNR in dB, and delivery in one hour
// of ten and in nine (coverage.h).
using Sample = std::array<double, 6>;

// Returns the function at each of `places`, which ascend, from calls of `compute` at some of them. Each value
// is within its tolerance, which must be 0 or more.
std::vector<Sample> sampled(const std::vector<double>& places, double longest, const Sample& tolerance,
                            const std::function<Sample(double place)>& compute);

}  // namespace halocline::clients
