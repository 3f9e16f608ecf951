// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/traffic/relay.h"

#include <algorithm>

#include "core/names.h"
#include "core/random.h"

namespace halocline::clients {
namespace {

// Retry after a refusal by a busy modem: kShortestRetry plus a random part of the greater of the longest wait
// and kLongestRetry.
constexpr SimDuration kShortestRetry = SimDuration::from_milliseconds(500);
constexpr SimDuration kLongestRetry = SimDuration::from_milliseconds(2000);

}  // namespace

void RelayCounters::add(const RelayCounters& other) {
  originated += other.originated;
  delivered += other.delivered;
  confirmed += other.confirmed;
  passed_on += other.passed_on;
  duplicates += other.duplicates;
  expired += other.expired;
  retried += other.retried;
  dropped += other.dropped;
}

Relay::Relay(std::int32_t vehicle_id, RelayRules rules, std::uint64_t seed)
    : vehicle_id_(vehicle_id), rules_(rules), seed_(seed) {}

void Relay::originate(std::int32_t destination, std::vector<std::uint8_t> payload, SimTime at) {
  const bool confirmed = rules_.confirmed && destination != kBroadcastId;
  RelayPacket packet{confirmed ? RelayKind::kDataToConfirm : RelayKind::kData,
                     rules_.hops,
                     rules_.hops - 1,
                     vehicle_id_,
                     destination,
                     next_number_++,
                     std::move(payload)};
  ++changes_;
  ++counters_.originated;
  store(std::move(packet), at, 0);
}

void Relay::take(std::span<const std::uint8_t> bytes, SimTime at) {
  auto packet = decode_relay_packet(bytes);
  if (!packet) return;
  ++changes_;
  if (packet->origin == vehicle_id_ || !is_new(packet->name())) {
    ++counters_.duplicates;
    return;
  }
  const bool for_us = packet->destination == vehicle_id_;
  if (for_us || packet->destination == kBroadcastId) deliver(*packet, at);
  if (for_us || !rules_.passes_on) return;
  if (packet->hops_left == 0) {
    ++counters_.expired;
    return;
  }
  --packet->hops_left;
  const SimDuration wait = wait_before(*packet, 0);
  store(std::move(*packet), at + wait, 0);
}

void Relay::deliver(const RelayPacket& packet, SimTime at) {
  if (packet.kind == RelayKind::kConfirmation) {
    ++counters_.confirmed;
    return;
  }
  ++counters_.delivered;
  if (delivery_handler_) delivery_handler_(packet, at);
  if (packet.kind != RelayKind::kDataToConfirm) return;
  // The confirmation bears the number of the confirmed packet.
  RelayPacket confirmation{RelayKind::kConfirmation,
                           packet.hops_allowed,
                           packet.hops_allowed - 1,
                           vehicle_id_,
                           packet.origin,
                           packet.number,
                           {}};
  const SimDuration wait = wait_before(confirmation, 0);
  store(std::move(confirmation), at + wait, 0);
}

SimTime Relay::next() const {
  SimTime next = SimTime::never();
  for (const Stored& stored : stored_) next = std::min(next, stored.at);
  return next;
}

std::optional<Relay::Transmission> Relay::transmit_due(SimTime now) {
  const auto earliest = std::min_element(stored_.begin(), stored_.end(),
                                         [](const Stored& a, const Stored& b) { return a.at < b.at; });
  if (earliest == stored_.end() || earliest->at > now) return std::nullopt;
  ++changes_;
  in_hand_ = std::move(*earliest);
  stored_.erase(earliest);
  return Transmission{in_hand_->at, encode(in_hand_->packet)};
}

void Relay::on_sent(std::int64_t packet_sequence) {
  if (!in_hand_) return;
  ++changes_;
  in_hand_->packet_sequence = packet_sequence;
  transmitted_.push_back(std::move(*in_hand_));
  in_hand_.reset();
  if (transmitted_.size() > kMaxStored) transmitted_.erase(transmitted_.begin());  // never answered
}

void Relay::on_receipt(std::int64_t packet_sequence, Verdict verdict, SimTime at) {
  const auto found = std::find_if(transmitted_.begin(), transmitted_.end(),
                                  [&](const Stored& s) { return s.packet_sequence == packet_sequence; });
  if (found == transmitted_.end()) return;
  ++changes_;
  Stored stored = std::move(*found);
  transmitted_.erase(found);
  const bool others = stored.packet.origin != vehicle_id_;
  if (verdict == Verdict::kAccepted) {
    counters_.passed_on += others ? 1 : 0;
    return;
  }
  ++stored.tries;
  if (verdict == Verdict::kImpossible || stored.tries == kMaxTries) {
    ++counters_.dropped;
    return;
  }
  ++counters_.retried;
  const SimDuration wait = wait_before(stored.packet, stored.tries);
  store(std::move(stored.packet), at + wait, stored.tries);
}

void Relay::store(RelayPacket packet, SimTime at, int tries) {
  stored_.push_back({at, std::move(packet), tries, 0});
  if (stored_.size() <= kMaxStored) return;
  stored_.erase(stored_.begin());
  ++counters_.dropped;
}

bool Relay::is_new(const Name& name) {
  if (!known_.insert(name).second) return false;
  known_in_order_.push_back(name);
  if (known_in_order_.size() > kMaxKnown) {
    known_.erase(known_in_order_.front());
    known_in_order_.pop_front();
  }
  return true;
}

SimDuration Relay::wait_before(const RelayPacket& packet, int tries) const {
  const auto which =
      identity_of({static_cast<std::uint64_t>(packet.origin), static_cast<std::uint64_t>(packet.kind),
                   packet.number, static_cast<std::uint64_t>(tries)});
  const double share = uniform_at({.seed = seed_,
                                   .purpose = purpose_of("relay-wait"),
                                   .who = static_cast<std::uint32_t>(vehicle_id_),
                                   .which = which});
  if (tries == 0) return SimDuration::from_seconds(share * rules_.longest_wait.seconds());
  return kShortestRetry +
         SimDuration::from_seconds(share * std::max(rules_.longest_wait, kLongestRetry).seconds());
}

void Relay::move(SimDuration by) {
  ++changes_;
  for (Stored& stored : stored_) stored.at = moved(stored.at, by);
}

void Relay::clear() {
  ++changes_;
  stored_.clear();
  in_hand_.reset();
  transmitted_.clear();
  known_.clear();
  known_in_order_.clear();
}

void Relay::archive(Archive& a) {
  a(counters_, next_number_, stored_, transmitted_, known_, known_in_order_);
}

}  // namespace halocline::clients
