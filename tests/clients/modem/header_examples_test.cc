// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of clients/modem/, compiled and run
// (tests/docs/check_examples).
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/node.h"
#include "bus/transport/transport.h"
#include "clients/modem/blocking_modem.h"
#include "clients/modem/modem_client.h"
#include "core/names.h"
#include "core/sim_time.h"
#include "tests/clients/modem/fake_server.h"

namespace halocline::clients {
namespace {

const std::vector<std::uint8_t> payload{1, 2, 3};

// Compiled only: it opens a real network and waits for a channel server.
[[maybe_unused]] int run_blocking_modem(std::int64_t my_session) {
  int answers = 0;
  const auto lcm = bus::open_transport(bus::effective_url(""));
  BlockingModem modem(*lcm, {.vehicle = "auv-1", .vehicle_id = 1, .session = my_session});
  const auto sequence = modem.send(kBroadcastId, payload);
  if (sequence && modem.wait_receipt(*sequence, SimDuration::from_seconds(2))) {
    ++answers;
  }
  while (const auto packet = modem.wait_receive(SimDuration::from_seconds(60))) {
    ++answers;
  }
  if (modem.listen({.events = true})) {
    const auto event = modem.wait_event(SimDuration::from_seconds(60));
    answers += event.has_value();
  }
  return answers;
}

TEST(HeaderExamples, ModemClient) {
  lcm::LCM lcm("memq://");
  bus::Bus own_bus(lcm, {"node", 5});
  testing::FakeServer server(lcm, "auv-1");
  server.answers = true;
  const auto bus = [&]() -> bus::Bus& { return own_bus; };
  const std::int64_t session = 42;
  const bus::Now now;
  bool accepted = false;
  std::vector<std::int32_t> sources;
  ModemClient modem(bus(), {.vehicle = "auv-1", .vehicle_id = 1, .session = session});
  const std::int64_t sequence = modem.send(now.steady, now.sim, kBroadcastId, payload);
  server.deliver(/*send_session=*/9, /*source=*/7, /*packet_sequence=*/0);
  while (lcm.handleTimeout(0) > 0) {
  }
  if (const auto receipt = modem.receipt_of(sequence)) {
    accepted = receipt->receipt_result == modem_receipt_t::ACCEPTED;
  }
  while (const auto packet = modem.take_received()) {
    sources.push_back(packet->source_id);
  }
  EXPECT_TRUE(accepted);
  EXPECT_EQ(sources, std::vector<std::int32_t>{7});
}

}  // namespace
}  // namespace halocline::clients
