// SPDX-License-Identifier: BSD-3-Clause
// Pure ALOHA (Abramson 1970): a frame is transmitted at once, or when the own transmission under way has
// ended.
//
// With Poisson arrivals of G packets per packet's duration at a common receiver, no capture: S = G exp(-2 G)
// (Abramson 1970).
#include <memory>
#include <utility>

#include "clients/examples/networks/mac.h"

namespace halocline::networks {

std::unique_ptr<Mac> make_aloha(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Mac>(std::move(port), rules);
}

}  // namespace halocline::networks
