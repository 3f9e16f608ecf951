// SPDX-License-Identifier: BSD-3-Clause
// Pure ALOHA (Abramson 1970): a frame is transmitted at once, or when the vehicle's present transmission has
// ended.
//
// With Poisson arrivals of G packets per packet duration at a common receiver, without capture, the
// throughput is (Abramson 1970)
//
//   S = G exp(-2 G)
#include <memory>
#include <utility>

#include "clients/onboard/networks/mac.h"

namespace halocline::networks {

std::unique_ptr<Mac> make_aloha(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Mac>(std::move(port), rules);
}

}  // namespace halocline::networks
