// SPDX-License-Identifier: BSD-3-Clause
// Node that publishes the messages of a recording, each at its time.
#pragma once

#include <string>

#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "runs/analysis/recording.h"

namespace halocline::clients {

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
