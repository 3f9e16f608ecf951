// SPDX-License-Identifier: BSD-3-Clause
#include "bus/node_identity.h"

#include "core/random.h"

namespace halocline::bus {

std::int64_t session_of(std::uint64_t entropy, std::string_view name) {
  const std::uint64_t bits =
      bits_at({.seed = entropy, .purpose = purpose_of("session"), .who = purpose_of(name)});
  return static_cast<std::int64_t>(bits >> 1 | 1);  // positive, never 0
}

}  // namespace halocline::bus
