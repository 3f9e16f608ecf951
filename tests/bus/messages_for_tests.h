// SPDX-License-Identifier: BSD-3-Clause
// Messages for the tests of the bus: one valid message of each type, with lists of a length drawn by seed.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bus/messages/messages.h"
#include "tests/bus/lockstep/simulated_lockstep.h"

namespace halocline::bus::testing {

// Types to run a typed test over: TypesOf<AllMessages>::Type.
template <class Tuple>
struct TypesOf;
template <class... Messages>
struct TypesOf<std::tuple<Messages...>> {
  using Type = ::testing::Types<Messages...>;
};

// A message that passes every check; the same for the same seed. Seed 0 has empty lists where a type allows
// them.
template <class Message>
Message valid_message(unsigned seed);

}  // namespace halocline::bus::testing
