// SPDX-License-Identifier: BSD-3-Clause
// A Bus that repairs, with every channel subscribed to, and a timeline's store: messages in any order,
// repairs, heartbeats, requests and duplicate publishers among them, as time goes on.
#include <memory>
#include <string>
#include <string_view>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/transport/event_log.h"
#include "bus/transport/node_identity.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "runs/timeline/run_timeline.h"
#include "tests/fuzz/bus_message.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;

void subscribe_to_all(bus::Bus& bus) {
  bus::any_channel([&]<class Message>(const auto& channel) {
    if constexpr (std::is_convertible_v<decltype(channel), std::string_view>) {
      if (channel != bus::channels::kRepairRequest)  // the Bus itself has it
        bus.subscribe<Message>(channel, [](const Message&) {});
    } else if (std::string_view(channel.prefix) != bus::channels::kHeartbeat.prefix) {
      bus.subscribe<Message>(channel, [](std::string_view, const Message&) {});
    }
    return false;
  });
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bus::set_log_level(bus::LogLevel::kSilent);
  fuzz::Input input(data, size);
  lcm::LCM lcm("memq://");
  bus::Bus bus(lcm, {"monitor", 7});
  bus.set_outbox([](std::string_view, const void*, std::size_t) {});
  subscribe_to_all(bus);
  bus.enable_repair();
  clients::RunTimeline timeline;
  SimTime steady;
  while (!input.is_empty()) {
    if (const auto pause = input.number(); pause != 0) {
      steady = steady + SimDuration::from_milliseconds(4 * std::int64_t{pause});
      bus.set_steady(steady);
      bus.repair(steady, steady);
      sim_clock_t clock{};
      clock.utime = steady.to_utime();
      clock.session = 7;
      clock.sequence = pause;
      bus.publish(bus::channels::kClock, clock);
    }
    const fuzz::BusMessage message = fuzz::bus_message_from(input);
    if (message.channel.size() > 63) continue;  // LCM has none
    lcm.publish(message.channel, message.bytes.data(), static_cast<unsigned>(message.bytes.size()));
    while (lcm.handleTimeout(0) > 0) {
    }
    bus.rethrow_if_failed();
    timeline.add(steady.to_utime(), message.channel, message.bytes);
  }
  const bus::BusCounters& counters = bus.counters();
  ensure(counters.gaps >= 0 && counters.lost >= 0, "counters do not wrap");
  return 0;
}
