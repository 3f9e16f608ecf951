// SPDX-License-Identifier: BSD-3-Clause
// Non-persistent carrier sense multiple access (Kleinrock and Tobagi 1975): a frame is transmitted when no
// carrier is sensed; else the channel is sensed again after a random wait, `tries` times in all.
//
// With a, the travel time divided by the packet duration, and G attempts per packet duration, the throughput
// when all vehicles are at the travel time a from each other is
//
//   S = G exp(-a G) / (G (1 + 2 a) + exp(-a G))
//
// The modem senses the carrier: the sound of others above its threshold.
#include <memory>
#include <utility>

#include "clients/onboard/networks/mac.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

class Csma : public Mac {
 public:
  using Mac::Mac;

 protected:
  void attempt(SimTime now) override {
    ++tries_;
    if (!carrier_) {
      tries_ = 0;
      return transmit_first(now);
    }
    due_ = now + random_wait(rules_.backoff);
    if (tries_ < rules_.tries) return;
    tries_ = 0;
    drop_first(now);
  }

 private:
  int tries_ = 0;  // attempts of the first frame
};

}  // namespace

std::unique_ptr<Mac> make_csma(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Csma>(std::move(port), rules);
}

}  // namespace halocline::networks
