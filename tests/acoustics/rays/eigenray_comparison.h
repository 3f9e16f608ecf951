// SPDX-License-Identifier: BSD-3-Clause
// Compares the eigenrays of a solver with those of a dense fan (tests/acoustics/rays/brute_fan.h), within 30
// dB of the strongest: delay 1 us, level 0.05 dB, phase 1 degree, angles 0.01 degrees; bundles launched
// within 0.02 degrees of each other as their sum.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "tests/acoustics/rays/brute_fan.h"

namespace halocline::acoustics {

// Sums over links, and the greatest errors among eigenrays that match.
struct ComparisonCount {
  int links = 0, expected = 0, matched = 0, as_sum = 0, missing = 0, extra = 0, confirmed = 0;
  double delay_s = 0, level_db = 0, phase_deg = 0, angle_deg = 0;
};

BruteEigenray brute_of(const Eigenray& arrival);

// Fails the test for each eigenray that `found` lacks of `expected` or has besides. What the fan has not
// resolved is confirmed by `trace`, which returns the ray launched at an angle if it passes the receiver.
void compare_eigenrays(const std::string& where, const std::vector<BruteEigenray>& found,
                       const std::vector<BruteEigenray>& expected,
                       const std::function<std::optional<BruteEigenray>(double)>& trace,
                       ComparisonCount& count);

// One line: numbers and errors.
void print(const std::string& name, const ComparisonCount& count);

}  // namespace halocline::acoustics
