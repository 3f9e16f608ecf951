// SPDX-License-Identifier: BSD-3-Clause
// The marks and colours of outcomes: one table for reports and monitors.
//
// Seventeen outcomes are too many to distinguish by colour, so they share six classes, each with a mark of
// its own. Colours: Okabe and Ito 2008, which colour-blind people can distinguish.
#pragma once

#include <array>
#include <cstddef>

namespace halocline::clients {

struct OutcomeClass {
  const char* key;     // of style sheets and of the page: [a-z_]
  const char* label;   // for a person
  const char* mark;    // dot (a filled circle), ring, cross, bowtie, bar or dash
  const char* colour;  // "#rrggbb"
};

inline constexpr std::size_t kOutcomeClasses = 6;

// Received first, then what was lost.
const std::array<OutcomeClass, kOutcomeClasses>& outcome_classes();

// Index in outcome_classes() of an outcome by its number, below kOutcomes.
std::size_t class_of_outcome(std::size_t outcome);

}  // namespace halocline::clients
