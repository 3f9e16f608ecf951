// SPDX-License-Identifier: BSD-3-Clause
// Marks and colours of packet outcomes: one table for reports and monitors.
//
// There are more outcomes than can be distinguished by colour, so they share six classes, each with its own
// mark. The colours are those of Okabe and Ito 2008, which colour-blind people can distinguish.
#pragma once

#include <array>
#include <cstddef>

namespace halocline::clients {

struct OutcomeClass {
  const char* key;     // name in style sheets and in the page: [a-z_]
  const char* label;   // name for a reader
  const char* mark;    // dot (a filled circle), ring, cross, bowtie, bar or dash
  const char* colour;  // "#rrggbb"
};

inline constexpr std::size_t kOutcomeClasses = 6;

// Returns the classes: received first, then the kinds of loss.
const std::array<OutcomeClass, kOutcomeClasses>& outcome_classes();

// Returns the index in outcome_classes() of an outcome's number, which is below kOutcomes.
std::size_t class_of_outcome(std::size_t outcome);

}  // namespace halocline::clients
