// SPDX-License-Identifier: BSD-3-Clause
// Node that publishes the messages of a recording, each at its time.
#pragma once

#include <string>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"

namespace halocline::clients {

// Returns which messages a replay of the scenario needs: GPS, BATTERY and SENSORS too where a vehicle's
// clock, battery or noise depends on them. A propeller's noise at its vehicle's own hydrophone does by
// default.
Played played_in(const ScenarioConfig& config);

class ReplayNode : public bus::Node {
 public:
  ReplayNode(lcm::LCM& lcm, bus::NodeIdentity identity, Recording recording);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  Recording recording_;
  std::size_t next_ = 0;
};

}  // namespace halocline::clients
