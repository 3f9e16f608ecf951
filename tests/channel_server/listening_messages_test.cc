// SPDX-License-Identifier: BSD-3-Clause
// MODEM_EVENT and LISTEN, from the medium to the bus and back.
#include <gtest/gtest.h>

#include "bus/messages/message_checks.h"
#include "channel_server/messages/packet_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

TEST(ChannelServerMessages, AModemEventHoldsItsExactInstant) {
  ModemEvent event{"auv1", ModemEventKind::kPacketEnded};
  event.level = Decibels{110.5};
  event.sinr = Decibels{7.25};
  event.outcome = OutcomeKind::kCollided;
  event.source_id = 3;
  event.destination_id = 4;
  event.packet_duration = testing::for_s(1.25);
  event.packet_end = at_s(2.5);
  event.rate_number = 6;
  event.measured_arrival = at_s(1.125);
  const modem_event_t message = to_message(event, SimTime::from_nanoseconds(1'234'567'891));
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.event_ns, 1'234'567'891);
  EXPECT_EQ(message.utime, 1'234'568);
  EXPECT_EQ(message.modem_event, modem_event_t::PACKET_ENDED);
  EXPECT_EQ(message.level_db, 110.5);
  EXPECT_EQ(message.sinr_db, 7.25);
  EXPECT_EQ(message.packet_outcome, packet_outcome_t::COLLIDED);
  EXPECT_EQ(message.source_id, 3);
  EXPECT_EQ(message.destination_id, 4);
  EXPECT_EQ(message.packet_duration_s, 1.25);
  EXPECT_EQ(message.packet_end_utime, 2'500'000);
  EXPECT_EQ(message.rate_number, 6);
  EXPECT_EQ(message.arrival_utime, 1'125'000);
}

TEST(ChannelServerMessages, AListenKeepsHowTheModemReceives) {
  modem_listen_t message{};
  message.asleep = message.promiscuous = message.events = 1;
  message.wake_utime = 5'000'000;
  message.carrier_threshold_db = 12;
  const Listening listening = to_listening(message);
  EXPECT_TRUE(listening.is_asleep(at_s(4.9)));
  EXPECT_FALSE(listening.is_asleep(at_s(5)));
  EXPECT_TRUE(listening.promiscuous && listening.events);
  EXPECT_EQ(listening.carrier_threshold.value, 12);
  message.wake_utime = 0;
  EXPECT_TRUE(to_listening(message).is_asleep(at_s(1e6))) << "until another LISTEN";
}

}  // namespace
}  // namespace halocline::channel_server
