// SPDX-License-Identifier: BSD-3-Clause
// Two Buses joined by a network that loses, duplicates and delays datagrams.
#include "bus/repair/flow_repair.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/bus.h"
#include "bus/repair/flow_watch.h"
#include "bus/transport/event_log.h"
#include "bus/transport/node_identity.h"
#include "core/sim_time.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using testing::valid_message;

// Two hosts, each a memq bus of its own; what is published on one arrives at both, as on a multicast network.
class LossyNetwork {
 public:
  LossyNetwork(double loss, double doubled, unsigned seed) : loss_(loss), doubled_(doubled), random_(seed) {
    for (Host& host : hosts_) {
      host.network = this;
      host.lcm.subscribe(".*", &Host::on_message, &host)->setQueueCapacity(0);
    }
  }
  lcm::LCM& host(int i) { return hosts_[static_cast<std::size_t>(i)].lcm; }
  double& loss() { return loss_; }

  // Carries everything that is under way, each datagram 0 to 3 rounds late.
  void carry() {
    for (Host& host : hosts_) drain(host.lcm);
    std::vector<Datagram> later;
    for (Datagram& datagram : std::exchange(under_way_, {})) {
      if (datagram.rounds-- > 0) {
        later.push_back(std::move(datagram));
        continue;
      }
      Host& host = hosts_[static_cast<std::size_t>(datagram.to)];
      host.next_arrived = true;
      host.lcm.publish(datagram.channel, datagram.bytes.data(), static_cast<unsigned>(datagram.bytes.size()));
      drain(host.lcm);
    }
    under_way_.insert(under_way_.end(), later.begin(), later.end());
  }

 private:
  struct Datagram {
    int to;
    int rounds;
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  struct Host {
    lcm::LCM lcm{"memq://"};
    LossyNetwork* network = nullptr;
    bool next_arrived = false;  // the next message came over the network, and does not go back
    void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      if (std::exchange(next_arrived, false)) return;
      const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
      network->send(this == network->hosts_.data() ? 1 : 0, channel, {bytes, bytes + buffer->data_size});
    }
  };
  static void drain(lcm::LCM& lcm) {
    while (lcm.handleTimeout(0) > 0) {
    }
  }
  void send(int to, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    std::uniform_real_distribution<double> share(0, 1);
    std::uniform_int_distribution<int> rounds(0, 3);
    const int copies = share(random_) < doubled_ ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      if (share(random_) >= loss_) under_way_.push_back({to, rounds(random_), channel, bytes});
    }
  }

  double loss_, doubled_;
  std::mt19937 random_;
  std::array<Host, 2> hosts_;
  std::vector<Datagram> under_way_;
};

// A publisher of STATE.a on one host, a receiver on the other; a millisecond of steady time a round.
class FlowRepairTest : public ::testing::Test {
 protected:
  void start(double loss, double doubled = 0, unsigned seed = 1) {
    set_log_level(LogLevel::kSilent);
    publisher_.reset();
    receiver_.reset();
    network_.emplace(loss, doubled, seed);
    publisher_.emplace(network_->host(0), NodeIdentity{"publisher", 77});
    receiver_.emplace(network_->host(1), NodeIdentity{"receiver", 88});
    receiver_->subscribe<vehicle_state_t>(
        channels::kState, [this](std::string_view, const vehicle_state_t& m) { ++received_[m.sequence]; });
  }
  void enable_repair() {
    publisher_->enable_repair();
    receiver_->enable_repair();
  }
  ~FlowRepairTest() override { set_log_level(LogLevel::kInfo); }

  void publish() {
    vehicle_state_t state = valid_message<vehicle_state_t>(1);
    state.session = 77;
    state.sequence = published_++;
    publisher_->publish("STATE.a", state);
  }
  void pass(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      steady_ = steady_ + SimDuration::from_milliseconds(1);
      for (Bus* bus : {&*publisher_, &*receiver_}) {
        bus->set_steady(steady_);
        if (bus->next_repair() <= steady_) bus->repair(steady_, steady_);
      }
      network_->carry();
    }
  }
  bool received_each_once() const {
    return received_.size() == static_cast<std::size_t>(published_) &&
           std::all_of(received_.begin(), received_.end(),
                       [](const auto& entry) { return entry.second == 1; });
  }

  std::optional<LossyNetwork> network_;
  std::optional<Bus> publisher_, receiver_;
  std::map<std::int64_t, int> received_;
  std::int64_t published_ = 0;
  SimTime steady_;
};

TEST_F(FlowRepairTest, EveryMessageIsReceivedOnceWhateverTheNetworkLosesDuplicatesAndDelays) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    received_.clear();
    published_ = 0;
    start(0.2, 0.1, seed);
    enable_repair();
    pass(10);
    for (int i = 0; i < 300; ++i) {
      publish();
      pass(5);
    }
    pass(5000);
    EXPECT_TRUE(received_each_once()) << "seed " << seed << ": " << received_.size() << " of " << published_;
    EXPECT_EQ(receiver_->counters().gaps, receiver_->counters().repaired);
    EXPECT_GT(receiver_->counters().repaired, 30);
    EXPECT_EQ(receiver_->counters().lost, 0);
  }
}

TEST_F(FlowRepairTest, WithoutRepairLostMessagesStayLost) {
  start(0.2);
  for (int i = 0; i < 300; ++i) {
    publish();
    pass(5);
  }
  EXPECT_LT(received_.size(), 280u);
  EXPECT_GT(receiver_->counters().gaps, 20);
}

TEST_F(FlowRepairTest, TheOnlyMessageOfAFlowIsRepairedByTheHeartbeat) {
  start(0);
  enable_repair();
  pass(600);
  network_->loss() = 1;
  publish();
  pass(10);
  network_->loss() = 0;
  EXPECT_TRUE(received_.empty());
  pass(300);
  EXPECT_TRUE(received_each_once());
}

TEST_F(FlowRepairTest, AReceiverOlderThanThePublisherMissesNoneOfItsFirstMessages) {
  start(0);
  receiver_->enable_repair();
  pass(1000);
  publisher_->enable_repair();
  network_->loss() = 1;
  publish();
  publish();
  pass(100);
  network_->loss() = 0;
  pass(600);
  EXPECT_TRUE(received_each_once());
}

TEST_F(FlowRepairTest, AReceiverThatStartedLaterRequestsNothingFromBefore) {
  start(0);
  publisher_->enable_repair();
  network_->loss() = 1;  // no receiver yet
  for (int i = 0; i < 5; ++i) publish();
  pass(1000);
  network_->loss() = 0;
  receiver_->enable_repair();
  pass(1000);
  publish();
  pass(1000);
  EXPECT_EQ(received_.size(), 1u);
  EXPECT_EQ(received_.count(5), 1u);
  EXPECT_LE(receiver_->counters().gaps, 1);  // a heartbeat may be reordered with the message that it names
}

TEST_F(FlowRepairTest, AGapOfAPublisherWithoutHistoryIsCountedAsLost) {
  start(0);
  receiver_->enable_repair();
  publish();
  pass(10);
  network_->loss() = 1;
  for (int i = 0; i < 3; ++i) publish();
  pass(10);
  network_->loss() = 0;
  publish();
  pass(11'000);
  EXPECT_EQ(receiver_->counters().gaps, 3);
  EXPECT_EQ(receiver_->counters().repaired, 0);
  EXPECT_EQ(receiver_->counters().lost, 3);
}

TEST_F(FlowRepairTest, ASendThatItsSenderRepeatsIsReceivedEachTimeAndOneOfRepairOnce) {
  start(0);
  enable_repair();
  int received = 0;
  receiver_->subscribe<modem_send_t>(channels::kSend,
                                     [&](std::string_view, const modem_send_t&) { ++received; });
  modem_send_t send = valid_message<modem_send_t>(1);
  for (const char* channel : {"SEND.a", "SEND.a", "SEND.a", "REPAIR.SEND.a"}) {
    publisher_->publish(channel, send);
    pass(10);
  }
  EXPECT_EQ(received, 3);
}

// How many messages of a flow that a heartbeat did not list are missing when it is received for the first
// time, with number 1000.
std::int64_t missing_of_unlisted_flow(int flows_kept) {
  FlowWatch watch;
  FlowRepair repair("receiver", 1, watch);
  flow_heartbeat_t heartbeat{};
  heartbeat.session = 9;
  heartbeat.sequence = 4000;
  heartbeat.age_us = 1'000'000'000;
  heartbeat.num_flows_kept = flows_kept;
  heartbeat.num_flows = 1;
  heartbeat.flow_channel = {"STATE.a"};
  heartbeat.flow_session = {9};
  heartbeat.flow_last_sequence = {5};
  const auto any = [](std::string_view) { return true; };
  for (const double steady_s : {1.0, 1.25})
    EXPECT_EQ(repair.on_heartbeat(SimTime::from_seconds(steady_s), "publisher", heartbeat, any), 0);
  return watch.on_message(SimTime::from_seconds(2), "STATE.b", 9, 1000).newly_missing;
}

TEST(FlowRepair, AFlowThatAWholeHeartbeatDidNotListBeganAfterIt) {
  EXPECT_EQ(missing_of_unlisted_flow(1), 1000);
}
TEST(FlowRepair, AFlowThatAHeartbeatLeftOutMayHaveBegunBefore) { EXPECT_EQ(missing_of_unlisted_flow(2), 0); }

TEST(FlowRepair, AReceiverThatIsBehindRequestsNothing) {
  lcm::LCM lcm("memq://");
  Bus receiver(lcm, {"receiver", 1}), publisher(lcm, {"publisher", 2});
  int requests = 0;
  publisher.subscribe<repair_request_t>(channels::kRepairRequest,
                                        [&](const repair_request_t&) { ++requests; });
  receiver.subscribe<vehicle_state_t>(channels::kState, [](std::string_view, const vehicle_state_t&) {});
  receiver.enable_repair();
  auto state = valid_message<vehicle_state_t>(1);
  for (const std::int64_t sequence : {0, 5}) {
    state.sequence = sequence;
    publisher.publish("STATE.a", state);
  }
  const auto requested_by = [&](double steady_s, bool may_request) {
    while (lcm.handleTimeout(0) > 0) {
    }
    receiver.repair(SimTime(), SimTime::from_seconds(steady_s), may_request);
    while (lcm.handleTimeout(0) > 0) {
    }
    return requests;
  };
  EXPECT_EQ(requested_by(1, false), 0);
  EXPECT_EQ(requested_by(2, true), 1);
}

TEST_F(FlowRepairTest, AnswersLeaveInTheStepNotInTheHandler) {
  start(0);
  enable_repair();
  publish();
  repair_request_t request = valid_message<repair_request_t>(1);
  request.missing_channel = "STATE.a";
  request.publisher_session = 77;
  request.missing_sequence = {0};
  request.num_missing = 1;
  publisher_->repair(steady_, steady_);
  const std::int64_t sent = publisher_->counters().sent;
  for (int i = 0; i < 50; ++i) publisher_->deliver(channels::kRepairRequest, encoded(request));
  EXPECT_EQ(publisher_->counters().sent, sent);
  EXPECT_LE(publisher_->next_repair(), steady_);
  publisher_->repair(steady_, steady_);
  EXPECT_EQ(publisher_->counters().sent, sent + 1);
}

// What a second vehicle simulator of the same name publishes is refused until the first is silent, and then
// repaired.
TEST_F(FlowRepairTest, OfTwoPublishersOfOneNameTheFirstIsReceived) {
  start(0);
  enable_repair();
  Bus second(network_->host(0), NodeIdentity{"publisher", 78});
  second.enable_repair();
  pass(300);
  std::int64_t sequence = 0;
  const auto publish_as_second = [&] {
    vehicle_state_t state = valid_message<vehicle_state_t>(2);
    state.session = 78;
    state.sequence = 1000 + sequence++;
    second.publish("STATE.a", state);
    second.set_steady(steady_);
    second.repair(steady_, steady_);
  };
  for (int i = 0; i < 100; ++i) {
    publish();
    publish_as_second();
    pass(50);
  }
  EXPECT_TRUE(received_each_once());
  EXPECT_GT(receiver_->counters().duplicate_publishers, 100);
  EXPECT_GT(publisher_->counters().duplicate_publishers, 10);
}

TEST_F(FlowRepairTest, ARequestForAnUnknownMessageIsIgnored) {
  start(0);
  enable_repair();
  publish();
  repair_request_t request = valid_message<repair_request_t>(1);
  request.missing_channel = "STATE.a";
  request.publisher_session = 12345;
  receiver_->publish(channels::kRepairRequest, request);
  pass(20);
  EXPECT_TRUE(received_each_once());
}

}  // namespace
}  // namespace halocline::bus
