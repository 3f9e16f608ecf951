// SPDX-License-Identifier: BSD-3-Clause
// Holds a running bus to what it promises about packets (docs/packets.md): every SEND is answered by one
// RECEIPT, every accepted packet has exactly one outcome at each other vehicle, and a vehicle gets a RECEIVE
// exactly where the outcome says so. A node as any other: its messages are repaired. At its end it prints
// what it counted, a line; scripts/soak reads it.
//
// A packet is judged when it and kSettled have passed: repair gives up after 10 s.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bus/config/scenario.h"
#include "bus/messages/channels.h"
#include "bus/runtime/node.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/node_identity.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline {
namespace {

constexpr SimDuration kSettled = SimDuration::from_milliseconds(15'000);

struct Packet {
  SimTime last_heard;             // of its SEND, RECEIPT, end
  SimTime first_sent, last_sent;  // when its SEND was heard
  bool answered = false, accepted = false;
  std::string receipts;                                    // results in their order
  std::int32_t source = 0, destination = 0, outcomes = 0;  // possible receivers that have one
  std::map<std::int32_t, int> outcomes_of;                 // by receiver
  std::set<std::int32_t> received, receptions;             // by outcome, by RECEIVE
};

class Witness : public bus::Node {
 public:
  Witness(lcm::LCM& lcm, bus::NodeIdentity identity, const bus::Scenario& scenario)
      : Node(lcm, std::move(identity)), others_(static_cast<int>(scenario.vehicles.size()) - 1) {
    using bus::channels::kReceipt, bus::channels::kReceive, bus::channels::kSend;
    bus().subscribe<modem_send_t>(kSend, [this](std::string_view, const modem_send_t& m) {
      Packet& sent = packet(m.session, m.packet_sequence, m.packet_kind);
      if (sent.source == 0) sent.first_sent = now_;
      sent.last_sent = now_;
      sent.source = m.source_id;
      sent.destination = m.destination_id;
      kinds_[{m.session, m.packet_sequence}] = m.packet_kind;
    });
    bus().subscribe<modem_receipt_t>(kReceipt,
                                     [this](std::string_view, const modem_receipt_t& m) { take(m); });
    bus().subscribe<packet_outcome_t>(bus::channels::kOutcome,
                                      [this](const packet_outcome_t& m) { take(m); });
    bus().subscribe<modem_receive_t>(kReceive, [this](std::string_view, const modem_receive_t& m) {
      packet(m.send_session, m.packet_sequence, m.packet_kind).receptions.insert(m.receiver_id);
    });
  }

 protected:
  bus::Due on_due() const override { return {next_check_}; }
  void on_step(const bus::Now& now) override {
    if (!now.sim_known) return;
    now_ = now.sim;
    next_check_ = now_ + SimDuration::from_milliseconds(1000);
    std::erase_if(packets_, [&](const auto& entry) {
      if (now_ - entry.second.last_heard < kSettled) return false;
      judge(entry.first, entry.second);
      return true;
    });
    std::erase_if(kinds_, [&](const auto& entry) {
      return !packets_.contains({std::get<0>(entry.first), std::get<1>(entry.first), entry.second});
    });
  }
  void on_stop(const bus::Now&) override {
    std::printf("witness: %s\n", status_text().c_str());
    std::fflush(stdout);
  }
  std::string status_text() const override {
    return fmt::format("packets={} refused={} receptions={} broken={} lost={}", num_packets_, num_refused_,
                       num_receptions_, num_broken_, counters().lost);
  }

 private:
  using Key = std::tuple<std::int64_t, std::int64_t, int>;  // session, sequence, kind

  Packet& packet(std::int64_t session, std::int64_t sequence, int kind) {
    Packet& packet = packets_[{session, sequence, kind}];
    packet.last_heard = std::max(packet.last_heard, now_);
    return packet;
  }
  void take(const modem_receipt_t& m) {
    const auto kind = kinds_.find({m.send_session, m.packet_sequence});
    if (kind == kinds_.end()) return;
    Packet& answered = packet(m.send_session, m.packet_sequence, kind->second);
    answered.answered = true;
    answered.receipts += fmt::format("{}@{:.3f},", m.receipt_result, SimTime::from_utime(m.utime).seconds());
    answered.accepted =
        m.receipt_result == modem_receipt_t::ACCEPTED || m.receipt_result == modem_receipt_t::QUEUED;
    const SimTime end = SimTime::from_utime(m.start_utime) + SimDuration::from_seconds(m.duration_s);
    if (answered.accepted) answered.last_heard = std::max(answered.last_heard, end);
  }
  void take(const packet_outcome_t& m) {
    Packet& of = packet(m.send_session, m.packet_sequence, m.packet_kind);
    of.outcomes += m.num_receivers;
    if (m.receiver_id != 0 && ++of.outcomes_of[m.receiver_id] > 1)
      bus().log().warning(
          "doubled", fmt::format("packet={}/{}/{} receiver={} session={} sequence={}", m.source_id,
                                 m.send_session, m.packet_sequence, m.receiver_id, m.session, m.sequence));
    if (m.outcome == packet_outcome_t::RECEIVED) of.received.insert(m.receiver_id);
  }

  void judge(const Key& key, const Packet& p) {
    // Sent before this one listened, or made by a modem (replies): no SEND was heard.
    if (p.source == 0) return;
    ++num_packets_;
    num_refused_ += p.answered && !p.accepted ? 1 : 0;
    num_receptions_ += static_cast<int>(p.receptions.size());
    std::string broken;
    // A sender repeats it until it is answered, for 10 s; one that died meanwhile is promised nothing.
    if (!p.answered && p.last_sent - p.first_sent > SimDuration::from_milliseconds(5000))
      broken += " no-receipt";
    if (p.accepted && p.outcomes != others_) broken += fmt::format(" outcomes={}/{}", p.outcomes, others_);
    if (!p.accepted && p.outcomes != 0) broken += " outcomes-of-refused";
    for (const auto& [receiver, count] : p.outcomes_of)
      if (count != 1 || receiver == p.source) broken += fmt::format(" receiver-{}={}", receiver, count);
    // Others than the destination have the outcome RECEIVED, and no RECEIVE.
    for (const std::int32_t receiver : p.receptions)
      if (!p.received.contains(receiver)) broken += fmt::format(" received-without-outcome={}", receiver);
    for (const std::int32_t receiver : p.received) {
      const bool is_for_it = p.destination == kBroadcastId || p.destination == receiver;
      if (is_for_it && std::get<2>(key) == modem_send_t::DATA && !p.receptions.contains(receiver))
        broken += fmt::format(" no-receive={}", receiver);
    }
    if (broken.empty()) return;
    ++num_broken_;
    bus().log().warning(
        "broken", fmt::format("session={} sequence={} kind={} source={} sent={:.3f} at={:.3f} receipts={}{}",
                              std::get<0>(key), std::get<1>(key), std::get<2>(key), p.source,
                              p.first_sent.seconds(), p.last_heard.seconds(), p.receipts, broken));
  }

  int others_;
  SimTime now_, next_check_;
  std::map<Key, Packet> packets_;
  std::map<std::pair<std::int64_t, std::int64_t>, int> kinds_;  // of the SENDs of packets_
  std::int64_t num_packets_ = 0, num_refused_ = 0, num_receptions_ = 0, num_broken_ = 0;
};

}  // namespace
}  // namespace halocline

int main(int argc, char** argv) {
  halocline::bus::NodeProgram program;
  program.program = "soak_witness";
  program.purpose = "Holds a running bus to what it promises about packets; for scripts/soak.";
  program.node_name = "witness";
  program.interface = "receives:  CLOCK, SEND.*, RECEIPT.*, OUTCOME, RECEIVE.*\npublishes: STATUS.<name>";
  program.make_node = [](const halocline::bus::NodeProgram::Context& context) {
    return std::make_unique<halocline::Witness>(context.lcm, context.identity, context.scenario);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
