// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/packet_book.h"

#include <algorithm>
#include <cstdlib>

namespace halocline::clients {
namespace {

constexpr std::int64_t kRounding_us = 1;  // rounding error of an instant in microseconds
// Kinds of packets that a SEND may hold; a receipt does not name the kind of its packet.
constexpr std::int8_t kSentKinds[] = {modem_receive_t::DATA, modem_receive_t::PING,
                                      modem_receive_t::MINI_PACKET, modem_receive_t::JANUS,
                                      modem_receive_t::JANUS_CARGO};

bool is_same(SimTime a, SimTime b) { return std::abs(a.to_utime() - b.to_utime()) <= kRounding_us; }

}  // namespace

bool PacketRecord::is_refused() const {
  return receipt && *receipt != modem_receipt_t::ACCEPTED && *receipt != modem_receipt_t::QUEUED;
}

SimTime arrival_of(const packet_outcome_t& outcome) {
  return SimTime::from_utime(outcome.departure_utime) + SimDuration::from_seconds(outcome.travel_time_s);
}

SimTime end_of(const packet_outcome_t& outcome) {
  const double factor = outcome.strongest_path_doppler_factor;
  return arrival_of(outcome) + SimDuration::from_seconds(outcome.duration_s / (factor > 0 ? factor : 1));
}

SimTime PacketRecord::end() const {
  SimTime end = at() + SimDuration::from_seconds(duration_s);
  for (const packet_outcome_t& outcome : outcomes) end = std::max(end, end_of(outcome));
  return end;
}

template <class Predicate>
PacketRecord* PacketBook::newest(const PacketId& name, const Predicate& fits) {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) return nullptr;
  for (auto number = found->second.rbegin(); number != found->second.rend(); ++number) {
    PacketRecord& packet = at_number(*number);
    if (fits(packet)) return &packet;
  }
  return nullptr;
}

PacketRecord& PacketBook::new_packet(const PacketId& name) {
  PacketRecord& packet = packets_.emplace_back();
  packet.number = first_ + packets_.size() - 1;
  packet.name = name;
  numbers_[name].push_back(packet.number);
  return packet;
}

PacketRecord& PacketBook::touched(PacketRecord& packet) {
  packet.revision = ++revision_;
  return packet;
}

void PacketBook::add(const modem_send_t& send, std::int32_t source_id) {
  const PacketId name{source_id, send.packet_kind, send.session, send.packet_sequence};
  const SimTime sent = SimTime::from_utime(send.utime);
  if (newest(name, [&](const PacketRecord& p) { return p.sent == sent; }) != nullptr) return;
  PacketRecord* packet =
      newest(name, [&](const PacketRecord& p) { return !p.sent && (!p.departure || *p.departure >= sent); });
  if (packet == nullptr) packet = &new_packet(name);
  packet->sent = sent;
  packet->destination_id = send.destination_id;
  packet->payload_bytes = send.payload_size;
  touched(*packet);
}

void PacketBook::add(const modem_receipt_t& receipt, std::int32_t source_id) {
  const SimTime start = SimTime::from_utime(receipt.start_utime);
  const auto is_repetition = [&](const PacketRecord& p) {
    return p.receipt == receipt.receipt_result &&
           (p.is_refused() || (p.departure && is_same(*p.departure, start)));
  };
  const auto is_open = [&](const PacketRecord& p) {
    return !p.receipt && (!p.departure || is_same(*p.departure, start));
  };
  PacketRecord* packet = nullptr;
  PacketId name{source_id, 0, receipt.send_session, receipt.packet_sequence};
  for (const std::int8_t kind : kSentKinds) {
    name.kind = kind;
    if (packet == nullptr) packet = newest(name, is_open);
  }
  for (const std::int8_t kind : kSentKinds) {
    name.kind = kind;
    if (packet == nullptr && newest(name, is_repetition) != nullptr) return;
  }
  if (packet == nullptr) {
    name.kind = modem_receive_t::DATA;
    packet = &new_packet(name);
  }
  packet->receipt = receipt.receipt_result;
  if (!packet->is_refused()) {
    packet->departure = start;
    packet->duration_s = receipt.duration_s;
  } else if (!packet->sent) {
    packet->sent = SimTime::from_utime(receipt.utime);
  }
  touched(*packet);
}

bool PacketBook::add(const packet_outcome_t& outcome) {
  const PacketId name{outcome.source_id, outcome.packet_kind, outcome.send_session, outcome.packet_sequence};
  const SimTime departure = SimTime::from_utime(outcome.departure_utime);
  const auto fits = [&](const PacketRecord& p) {
    const bool has_outcomes = !p.outcomes.empty() || p.out_of_reach > 0;
    if (p.destination_id != outcome.destination_id && (p.sent || has_outcomes)) return false;
    return p.departure ? is_same(*p.departure, departure) : !p.is_refused() && p.at() <= departure;
  };
  PacketRecord* packet = newest(name, fits);
  if (packet == nullptr) packet = &new_packet(name);
  if (outcome.receiver_id == 0) {
    if (packet->out_of_reach > 0) return false;
    packet->out_of_reach = outcome.num_receivers;
  } else {
    const auto place = std::lower_bound(
        packet->outcomes.begin(), packet->outcomes.end(), outcome.receiver_id,
        [](const packet_outcome_t& o, std::int32_t receiver) { return o.receiver_id < receiver; });
    if (place != packet->outcomes.end() && place->receiver_id == outcome.receiver_id) return false;
    packet->outcomes.insert(place, outcome);
    ++outcome_count_;
  }
  packet->departure = departure;
  packet->duration_s = outcome.duration_s;
  packet->destination_id = outcome.destination_id;
  touched(*packet);
  return true;
}

std::vector<const PacketRecord*> PacketBook::between(SimTime from, SimTime to) const {
  std::vector<const PacketRecord*> found;
  for (const PacketRecord& packet : packets_) {
    if (packet.at() <= to && packet.end() >= from) found.push_back(&packet);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const PacketRecord* a, const PacketRecord* b) { return a->at() < b->at(); });
  return found;
}

const PacketRecord* PacketBook::find(std::uint64_t number) const {
  return number >= first_ && number - first_ < packets_.size() ? &packets_[number - first_] : nullptr;
}

void PacketBook::drop_first() {
  const auto numbers = numbers_.find(packets_.front().name);
  std::erase(numbers->second, packets_.front().number);
  if (numbers->second.empty()) numbers_.erase(numbers);
  outcome_count_ -= packets_.front().outcomes.size();
  packets_.pop_front();
  ++first_;
}

void PacketBook::drop_before(SimTime at) {
  while (!packets_.empty() && packets_.front().end() < at) drop_first();
}

void PacketBook::keep_outcomes(std::size_t at_most) {
  while (outcome_count_ > at_most) drop_first();
}

}  // namespace halocline::clients
