// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/run_metrics.h"

#include <cmath>
#include <stdexcept>

#include "tests/bus/logs/log_fixture.h"

namespace halocline::clients {
namespace {

using testing::TemporaryLog;

packet_outcome_t outcome(std::int64_t sequence, std::int32_t destination, std::int32_t receiver,
                         std::int8_t result, double travel_time_s = 0.1) {
  packet_outcome_t o{};
  o.num_receivers = 1;
  o.source_id = 1;
  o.destination_id = destination;
  o.receiver_id = receiver;
  o.packet_sequence = sequence;
  o.outcome = result;
  o.departure_utime = 1'000'000;
  o.utime = 1'000'000 + 2 * static_cast<std::int64_t>(travel_time_s * 1e6);
  o.travel_time_s = travel_time_s;
  return o;
}

RunMetrics of(TemporaryLog& file) {
  LogReader log(file.path());
  return metrics_of(log);
}

TEST(RunMetrics, DeliveryCountsThoseAPacketWasFor) {
  TemporaryLog file;
  file.add(1, "OUTCOME", outcome(0, 2, 2, packet_outcome_t::RECEIVED));
  file.add(1, "OUTCOME", outcome(0, 2, 3, packet_outcome_t::RECEIVED));  // overheard
  file.add(1, "OUTCOME", outcome(1, 0, 2, packet_outcome_t::SHADOW));
  file.add(1, "OUTCOME", outcome(1, 0, 3, packet_outcome_t::RECEIVED));
  const RunMetrics metrics = of(file);
  EXPECT_EQ(metrics.all.packets, 3);
  EXPECT_EQ(metrics.all.received, 2);
  EXPECT_DOUBLE_EQ(metrics[RunNumber::kDeliveryRatio], 2.0 / 3);
  EXPECT_EQ(metrics.outcomes[packet_outcome_t::RECEIVED], 3);
  EXPECT_EQ((metrics.by_pair.at({"1", "3"}).packets), 1);
}

TEST(RunMetrics, DelaysHaveNearestRankPercentiles) {
  TemporaryLog file;
  for (int i = 1; i <= 100; ++i)
    file.add(1, "OUTCOME", outcome(i, 2, 2, packet_outcome_t::RECEIVED, 0.01 * i));
  const RunMetrics metrics = of(file);
  EXPECT_NEAR(metrics[RunNumber::kDelayMean], 0.505, 1e-12);
  EXPECT_NEAR(metrics[RunNumber::kDelayMedian], 0.5, 1e-12);
  EXPECT_NEAR(metrics[RunNumber::kDelay90], 0.9, 1e-12);
  EXPECT_NEAR(metrics[RunNumber::kDelay99], 0.99, 1e-12);
  EXPECT_NEAR(metrics[RunNumber::kLatencyMean], 1.01, 1e-5);
}

TEST(RunMetrics, LoadAndUseOfTheChannelAreTimeOfPacketsOverTheRun) {
  TemporaryLog file;
  modem_receipt_t receipt{};
  receipt.duration_s = 2;
  for (receipt.packet_sequence = 0; receipt.packet_sequence < 3; ++receipt.packet_sequence)
    file.add(1, "RECEIPT.a", receipt);
  auto received = outcome(0, 2, 2, packet_outcome_t::RECEIVED),
       overheard = outcome(0, 2, 3, packet_outcome_t::RECEIVED),
       lost = outcome(1, 2, 2, packet_outcome_t::COLLIDED);
  for (packet_outcome_t* o : {&received, &overheard, &lost}) {
    o->duration_s = 2;
    file.add(20'000'000, "OUTCOME", *o);
  }
  EXPECT_DOUBLE_EQ(of(file)[RunNumber::kChannelLoad], 0.3);
  EXPECT_DOUBLE_EQ(of(file)[RunNumber::kChannelUse], 0.1);
}

TEST(RunMetrics, NetworksCountFromTheOfferToTheDelivery) {
  TemporaryLog file;
  network_event_t event{};
  event.origin_id = 1;
  for (int i = 0; i < 4; ++i) {
    event.network_event = network_event_t::OFFERED;
    event.packet_number = i;
    event.utime = event.offered_utime = i * 1'000'000;
    file.add(event.utime, "NETWORK_EVENT.a", event);
    if (i == 0) continue;
    event.network_event = i == 1 ? network_event_t::DROPPED : network_event_t::DELIVERED;
    event.utime += i * 10'000'000;
    event.hop_count = i;
    file.add(40'000'000, "NETWORK_EVENT.b", event);
  }
  const RunMetrics metrics = of(file);
  EXPECT_EQ(metrics[RunNumber::kNetworkOffered], 4);
  EXPECT_EQ(metrics[RunNumber::kNetworkDelivered], 2);
  EXPECT_DOUBLE_EQ(metrics[RunNumber::kNetworkDelayMean], 25);
  EXPECT_DOUBLE_EQ(metrics[RunNumber::kNetworkDelay90], 30);
  EXPECT_DOUBLE_EQ(metrics[RunNumber::kNetworkHopsMean], 2.5);
}

TEST(RunMetrics, APacketForAnotherThatIsOverheardIsNoThroughput) {
  TemporaryLog file;
  modem_receive_t packet{};
  packet.source_id = 1;
  packet.destination_id = 2;
  packet.payload_size = 10;
  packet.payload.resize(10);
  for (packet.receiver_id = 2; packet.receiver_id <= 3; ++packet.receiver_id)
    file.add(8'000'000, "RECEIVE.v" + std::to_string(packet.receiver_id), packet);
  EXPECT_DOUBLE_EQ(of(file)[RunNumber::kThroughput], 10);
}

TEST(RunMetrics, ThroughputIsPayloadOverTheRun) {
  TemporaryLog file;
  modem_receive_t packet{};
  packet.receiver_id = 2;
  packet.source_id = 1;
  packet.destination_id = 2;
  packet.payload_size = 100;
  packet.payload.resize(100);
  packet.strongest_path_doppler_factor = 1;
  file.add(1, "RECEIVE.auv-2", packet);
  file.add(40'000'000, "CLOCK", testing::clock_at(40'000'000));
  EXPECT_DOUBLE_EQ(of(file)[RunNumber::kThroughput], 20);
}

TEST(RunMetrics, AreReadAsTheyWereWritten) {
  TemporaryLog file;
  file.add(1, "OUTCOME", outcome(0, 2, 2, packet_outcome_t::SHADOW));
  const RunMetrics metrics = of(file), read = metrics_from_json(to_json(metrics));
  EXPECT_TRUE(std::isnan(read[RunNumber::kDelayMean]));
  EXPECT_EQ(read[RunNumber::kDeliveryRatio], 0);
  EXPECT_EQ(read.outcomes, metrics.outcomes);
  EXPECT_EQ(read.by_pair.size(), 1u);
  EXPECT_EQ(to_json(read), to_json(metrics));
  EXPECT_THROW(metrics_from_json("{}"), std::runtime_error);
}

}  // namespace
}  // namespace halocline::clients
