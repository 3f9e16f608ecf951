// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/replay_node.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bus/logs/log_reader.h"
#include "bus/runtime/lockstep_runner.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::clock_at;
using testing::state_at;
using testing::TemporaryLog;

Recording recording_of(TemporaryLog& file) {
  LogReader log(file.path());
  return read_recording(log);
}

TEST(ReplayNode, PublishesEachMessageAtItsTime) {
  TemporaryLog file;
  file.add(0, "CLOCK", clock_at(0));
  for (const std::int64_t utime : {100'000, 100'000, 250'000})
    file.add(utime, "STATE.auv-1", state_at(utime));
  lcm::LCM lcm("memq://");
  ReplayNode node(lcm, {"replay", 1}, recording_of(file));
  bus::LockstepRunner runner({&node});
  bus::Bus peer(lcm, {"peer", 1});
  std::vector<SimTime> received;
  peer.subscribe<vehicle_state_t>(bus::channels::kState, [&](std::string_view, const vehicle_state_t&) {
    received.push_back(runner.now());
  });
  runner.set_listener([&](SimTime, std::string_view channel, std::span<const std::uint8_t> message) {
    peer.deliver(channel, message);
  });
  runner.run_until(SimTime::from_seconds(1));
  EXPECT_EQ(received, (std::vector<SimTime>{SimTime::from_utime(100'000), SimTime::from_utime(100'000),
                                            SimTime::from_utime(250'000)}));
}

// The noise of propellers is on by default and goes by SENSORS.
TEST(ReplayNode, PlaysSensorsWhereNoiseClocksOrBatteriesDependOnThem) {
  const auto played = [](const std::vector<std::string>& overrides) {
    return played_in(load_scenario(HALOCLINE_SOURCE_DIR "/scenarios/seamount.toml", overrides));
  };
  EXPECT_EQ(played({}), Played::kWithEquipment);
  EXPECT_EQ(played({"propagation.fading=\"none\""}), Played::kStatesAndPackets);
  for (const char* equipment : {"vehicle.0.clock.drift_ppm=1", "vehicle.0.battery.capacity_wh=100"})
    EXPECT_EQ(played({"propagation.fading=\"none\"", equipment}), Played::kWithEquipment) << equipment;
}

}  // namespace
}  // namespace halocline::clients
