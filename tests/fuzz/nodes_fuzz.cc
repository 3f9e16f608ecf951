// SPDX-License-Identifier: BSD-3-Clause
// All nodes of a small scenario, and messages of others on their channels, as simulation time goes on: no
// node ends by what it receives.
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/lockstep_runner.h"
#include "bus/transport/event_log.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "tests/fuzz/bus_message.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

namespace {

using namespace halocline;

constexpr std::string_view kScenario = R"(
[scenario]
name = "fuzz"
duration_s = 60
[terrain]
kind = "slope"
size_north_m = 400
size_east_m = 400
spacing_m = 50
[terrain.slope]
depth_m = 40
slope = 0.01
[modem]
profile = "micromodem-fsk"
[[vehicle]]
name = "auv-1"
id = 1
start_ned_m = [50.0, 0.0, 10.0]
speed_mps = 1
[vehicle.battery]
[vehicle.mission]
waypoints = [[100.0, 0.0, 12.0], [-100.0, 0.0, 8.0]]
speed_mps = 1.5
at_end = "loop"
[vehicle.traffic]
period_s = 2
start_s = 0.5
destination = "all"
payload_bytes = 8
[[vehicle]]
name = "auv-2"
id = 2
model = "external"
start_ned_m = [-50.0, 20.0, 15.0]
[vehicle.localiser]
[[vehicle]]
name = "1"
id = 3
model = "fixed"
start_ned_m = [-50.0, 0.0, 5.0]
)";

const clients::ScenarioConfig& scenario(bool along_rays) {
  static fuzz::ScratchFile file(".toml");
  static const clients::ScenarioConfig straight =
      clients::load_scenario(file.write(kScenario), {"propagation.model=\"straight\""});
  static const clients::ScenarioConfig rays = clients::load_scenario(file.write(kScenario), {});
  return along_rays ? rays : straight;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bus::set_log_level(bus::LogLevel::kSilent);
  fuzz::Input input(data, size);
  lcm::LCM lcm("memq://");
  clients::Composition all(lcm, scenario(input.below(2) == 1), clients::Composition::kRun);
  bus::LockstepRunner runner(all.nodes());
  runner.run_until(SimTime() + SimDuration::from_milliseconds(100));
  for (int messages = 0; !input.is_empty() && messages < 40; ++messages) {
    const fuzz::BusMessage message = fuzz::bus_message_from(input);
    for (bus::Node* node : all.nodes()) node->receive(message.channel, message.bytes);
    const auto pause = SimDuration::from_milliseconds(4 * std::int64_t{input.number()});
    runner.run_until(runner.now() + pause);
  }
  runner.run_until(runner.now() + SimDuration::from_milliseconds(1000));
  return 0;
}
