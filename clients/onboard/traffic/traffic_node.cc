// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/traffic_node.h"

#include <algorithm>

#include "bus/config/scenario.h"
#include "bus/transport/subscription.h"

namespace halocline::clients {
namespace {

constexpr std::int32_t kNumberBytes = 8;
// A stored packet that has been due for longer than this, after a halt, starts now instead of in the past.
constexpr SimDuration kPromptly = SimDuration::from_milliseconds(1000);

// Returns the first time start + k period that is not before `time`.
SimTime next_packet_at(const VehicleTraffic& traffic, SimTime time) {
  if (traffic.period == SimDuration()) return SimTime::never();
  if (time <= traffic.start) return traffic.start;
  const std::int64_t period = traffic.period.nanoseconds();
  const std::int64_t passed = ((time - traffic.start).nanoseconds() + period - 1) / period;
  return traffic.start + traffic.period * passed;
}

}  // namespace

std::vector<std::uint8_t> traffic_payload(std::int64_t number, std::int32_t size) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(size));
  const auto bits = static_cast<std::uint64_t>(number);
  for (std::int32_t i = 0; i < size; ++i) {
    const std::uint64_t value = i < kNumberBytes ? bits >> (8 * i) : bits + static_cast<std::uint64_t>(i);
    payload[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value & 0xff);
  }
  return payload;
}

std::vector<std::uint8_t> payload_of(const VehicleTraffic& traffic, std::int64_t number) {
  constexpr std::uint64_t kMiniBits = 13, kJanusBits = 34;
  const auto size = static_cast<std::int32_t>(traffic.packet_bytes());
  std::vector<std::uint8_t> payload = traffic_payload(number, size);
  if (traffic.kind == modem_send_t::DATA || traffic.kind == modem_send_t::PING) return payload;
  const bool is_mini = traffic.kind == modem_send_t::MINI_PACKET;
  std::uint64_t bits =
      static_cast<std::uint64_t>(number) & ((1ull << (is_mini ? kMiniBits : kJanusBits)) - 1);
  for (std::size_t byte = is_mini ? 2 : 5; byte-- > 0; bits >>= 8)  // most significant byte first
    payload[byte] = static_cast<std::uint8_t>(bits & 0xff);
  return payload;
}

TrafficNode::TrafficNode(lcm::LCM& lcm, bus::NodeIdentity identity, const TrafficConfig& config)
    : Node(lcm, std::move(identity)), uses_relays_(config.uses_relays()), clocks_(bus(), config.clocks) {
  for (const VehicleTraffic& traffic : config.vehicles) add_sender(config, traffic);
}

void TrafficNode::add_sender(const TrafficConfig& config, const VehicleTraffic& traffic) {
  // Each vehicle has its own session, so that (session, packet_sequence) identifies a packet without its
  // sender.
  const auto entropy = static_cast<std::uint64_t>(bus().identity().session);
  // Received packets make the node due only when they may have to be relayed.
  const auto wakeup = uses_relays_ ? bus::Wakeup::kMayAdvanceDue : bus::Wakeup::kStoreOnly;
  const ModemAddress address{traffic.vehicle, traffic.vehicle_id, bus::session_of(entropy, traffic.vehicle)};
  senders_.emplace_back(new Sender{traffic,
                                   destination_id(config, traffic),
                                   {bus(), address, {}, wakeup},
                                   Relay(traffic.vehicle_id, traffic.relay, entropy),
                                   next_packet_at(traffic, clocks_.shown(traffic.vehicle_id, SimTime()))});
  Sender* sender = senders_.back().get();
  sender->modem.on_receive([this, sender](const modem_receive_t& packet) { on_packet(*sender, packet); });
  sender->modem.on_receipt([this, sender](const modem_receipt_t& receipt) { on_receipt(*sender, receipt); });
}

void TrafficNode::on_packet(Sender& sender, const modem_receive_t& packet) {
  bus().log().debug("packet-received", "vehicle=" + sender.traffic.vehicle +
                                           " source=" + std::to_string(packet.source_id) +
                                           " packet=" + std::to_string(packet.packet_sequence));
  if (uses_relays_ && is_whole(packet) && packet.packet_kind == modem_receive_t::DATA)
    sender.relay.take(packet.payload, shown(sender, SimTime::from_utime(packet.utime)));
}

void TrafficNode::on_receipt(Sender& sender, const modem_receipt_t& receipt) {
  using Verdict = Relay::Verdict;
  Verdict verdict = Verdict::kImpossible;
  switch (receipt.receipt_result) {
    case modem_receipt_t::ACCEPTED:
    case modem_receipt_t::QUEUED:
      verdict = Verdict::kAccepted;
      break;
    case modem_receipt_t::REFUSED_BUSY:
    case modem_receipt_t::REFUSED_QUEUE_FULL:
    case modem_receipt_t::REFUSED_UNKNOWN_VEHICLE:
      verdict = Verdict::kBusy;
      break;
    default:
      break;
  }
  sender.relay.on_receipt(receipt.packet_sequence, verdict,
                          shown(sender, SimTime::from_utime(receipt.utime)));
}

bus::Due TrafficNode::on_due() const {
  bus::Due due;
  for (const auto& sender : senders_) {
    const SimTime next = std::min(sender->next_packet, sender->relay.next());
    due.sim = std::min(due.sim, clocks_.due(sender->traffic.vehicle_id, next));
    due.steady = std::min(due.steady, sender->modem.next_resend());
  }
  return due;
}

void TrafficNode::on_step(const bus::Now& now) {
  clocks_.set_now(now.sim);
  for (const auto& sender : senders_) {
    send_due(*sender, now);
    transmit_due(*sender, now);
    sender->modem.resend(now.steady);
  }
}

void TrafficNode::send_due(Sender& sender, const bus::Now& now) {
  const SimTime own = shown(sender, now.sim);
  if (own < sender.next_packet) return;
  const VehicleTraffic& traffic = sender.traffic;
  // When the program is started into a running simulation, packets of the past are not sent.
  const SimTime latest = next_packet_at(traffic, own + SimDuration::from_nanoseconds(1)) - traffic.period;
  sender.set_next_packet(latest + traffic.period);
  if (traffic.is_relayed()) {
    const auto number = sender.relay.counters().originated;
    return sender.relay.originate(sender.destination, traffic_payload(number, traffic.payload_bytes), latest);
  }
  const auto number = sender.modem.counters().sent;
  SendOptions options{.kind = traffic.kind, .wants_ack = traffic.ack};
  if (traffic.rate >= 0) options.rate_number = traffic.rate;
  sender.modem.send(now.steady, clocks_.instant_of(traffic.vehicle_id, latest, now.sim), sender.destination,
                    payload_of(traffic, number), std::move(options));
}

void TrafficNode::transmit_due(Sender& sender, const bus::Now& now) {
  const SimTime own = shown(sender, now.sim);
  while (const auto transmission = sender.relay.transmit_due(own)) {
    const SimTime at = own - transmission->at < kPromptly ? transmission->at : own;
    const SimTime start = clocks_.instant_of(sender.traffic.vehicle_id, at, now.sim);
    SendOptions options;
    if (sender.traffic.rate >= 0) options.rate_number = sender.traffic.rate;
    sender.relay.on_sent(
        sender.modem.send(now.steady, start, kBroadcastId, transmission->bytes, std::move(options)));
  }
}

void TrafficNode::on_restart(const bus::Now& now) {
  clocks_.restart(now.sim);
  for (const auto& sender : senders_) {
    sender->set_next_packet(next_packet_at(sender->traffic, shown(*sender, now.sim)));
    sender->relay.clear();
  }
}

void TrafficNode::on_archive(Archive& a) {
  a(clocks_);
  for (const auto& sender : senders_) a.part(sender->changes(), *sender);
}

std::string TrafficNode::status_text() const {
  ModemCounters sum;
  for (const auto& sender : senders_) {
    const ModemCounters& counters = sender->modem.counters();
    sum.sent += counters.sent;
    sum.accepted += counters.accepted;
    sum.refused += counters.refused;
    sum.received += counters.received;
    sum.acknowledged += counters.acknowledged;
  }
  return "sent " + std::to_string(sum.sent) + ", accepted " + std::to_string(sum.accepted) + ", refused " +
         std::to_string(sum.refused) + ", received " + std::to_string(sum.received) +
         (sum.acknowledged > 0 ? ", acknowledged " + std::to_string(sum.acknowledged) : "") + relay_text();
}

std::string TrafficNode::relay_text() const {
  if (!uses_relays_) return "";
  RelayCounters sum;
  for (const auto& sender : senders_) sum.add(sender->relay.counters());
  return "; end to end: sent " + std::to_string(sum.originated) + ", delivered " +
         std::to_string(sum.delivered) + ", confirmed " + std::to_string(sum.confirmed) + "; passed on " +
         std::to_string(sum.passed_on) + ", duplicates " + std::to_string(sum.duplicates) + ", expired " +
         std::to_string(sum.expired) + ", tried again " + std::to_string(sum.retried) + ", dropped " +
         std::to_string(sum.dropped);
}

}  // namespace halocline::clients
