// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/outcome_classes.h"

#include "bus/messages/messages.h"

namespace halocline::clients {
namespace {

constexpr std::array<OutcomeClass, kOutcomeClasses> kClasses{{
    {"received", "received", "dot", "#009e73"},
    {"not_acquired", "not acquired", "ring", "#56b4e9"},
    {"bit_errors", "bit errors", "cross", "#d55e00"},
    {"collided", "collided", "bowtie", "#cc79a7"},
    {"half_duplex", "half duplex", "bar", "#e69f00"},
    {"no_path", "out of reach", "dash", "#0072b2"},
}};

}  // namespace

const std::array<OutcomeClass, kOutcomeClasses>& outcome_classes() { return kClasses; }

std::size_t class_of_outcome(std::size_t outcome) {
  switch (outcome) {
    case packet_outcome_t::RECEIVED:
      return 0;
    case packet_outcome_t::NOT_ACQUIRED:
      return 1;
    case packet_outcome_t::BIT_ERRORS:
    case packet_outcome_t::DOPPLER:
    case packet_outcome_t::EXTRA_LOSS:
      return 2;
    case packet_outcome_t::COLLIDED:
      return 3;
    case packet_outcome_t::HALF_DUPLEX:
    case packet_outcome_t::ASLEEP:
      return 4;
    default:
      return 5;
  }
}

}  // namespace halocline::clients
