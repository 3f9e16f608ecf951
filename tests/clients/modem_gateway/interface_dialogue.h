// SPDX-License-Identifier: BSD-3-Clause
// Modem interfaces of a run in quiet water without losses, and their hosts, in steps of a twentieth of a
// second.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/sim_time.h"
#include "tests/clients/modem_gateway/host.h"
#include "tests/clients/modem_gateway/interface_run.h"

namespace halocline::modem_gateway::testing {

class InterfaceDialogue {
 public:
  // A host for each vehicle with a modem interface, in their order. `lost`: share of the packets.
  explicit InterfaceDialogue(const std::vector<InterfaceVehicle>& vehicles, double lost = 0)
      : run(vehicles, lost) {
    wait(1);
    std::size_t interfaces = 0;
    for (const InterfaceVehicle& vehicle : vehicles) interfaces += vehicle.kind.empty() ? 0 : 1;
    for (std::size_t i = 0; i < interfaces; ++i)
      hosts.push_back(std::make_unique<Host>(run.gateway().place_of(i)));
    heard.resize(hosts.size());
  }
  // `work` is called after each step.
  void wait(double seconds, const std::function<void()>& work = {}) {
    for (int i = 0; i < 20 * seconds; ++i) {
      now_s += 0.05;
      run.run_until(SimTime::from_seconds(now_s));
      for (std::size_t k = 0; k < hosts.size(); ++k) heard[k] += hosts[k]->read();
      if (work) work();
    }
  }
  // What each host has read after `host` wrote that.
  void say(std::size_t host, const std::string& text, double seconds) {
    for (std::string& each : heard) each.clear();
    hosts[host]->write(text);
    wait(seconds);
  }

  InterfaceRun run;
  std::vector<std::unique_ptr<Host>> hosts;
  std::vector<std::string> heard;
  double now_s = 0;
};

// Sentences, in their order, that stand in what was read; the rest between them may be anything.
inline ::testing::Matcher<const std::string&> has_in_turn(const std::vector<std::string>& sentences) {
  return ::testing::ResultOf(
      [sentences](const std::string& text) {
        std::size_t at = 0, found = 0;
        for (const std::string& sentence : sentences) {
          at = text.find(sentence, at);
          if (at == std::string::npos) break;
          at += sentence.size();
          ++found;
        }
        return found;
      },
      sentences.size());
}

}  // namespace halocline::modem_gateway::testing
