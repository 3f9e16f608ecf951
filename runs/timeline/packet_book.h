// SPDX-License-Identifier: BSD-3-Clause
// Packets of a run: each transmission with its SEND, its receipt and its outcome at every receiver, joined by
// the packet's name.
//
// A packet's name consists of its sender's id, session, sequence and kind. When a name is used more than once
// (by a publisher without sessions that was restarted), transmissions are told apart by their departure. Any
// part may be missing or come first: a log may begin late, and the reply to a ping has no SEND.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "bus/messages/messages.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Name by which the messages about a packet are joined.
struct PacketId {
  std::int32_t source_id = 0;
  std::int8_t kind = 0;  // packet_outcome_t.packet_kind
  std::int64_t session = 0, sequence = 0;
  auto operator<=>(const PacketId&) const = default;
};

// One transmission, or a SEND that was refused or is not yet transmitted.
struct PacketRecord {
  std::uint64_t number = 0;  // in the order of first messages; never changes
  PacketId name;
  std::int32_t destination_id = 0;  // 0: broadcast
  std::optional<SimTime> sent;      // time of its SEND, or of the receipt that refused it; empty: not known
  std::int32_t payload_bytes = -1;  // -1: unknown
  std::optional<std::int8_t> receipt;  // modem_receipt_t.ACCEPTED, ...; empty: none was received
  std::optional<SimTime> departure;    // empty: refused, or not known yet
  double duration_s = 0;
  std::vector<packet_outcome_t> outcomes;  // at most one for each receiver, sorted by the receiver's id
  std::int64_t out_of_reach = 0;           // number of further receivers, summed up in one OUTCOME
  std::uint64_t revision = 0;              // value of PacketBook::revision() at its last change

  bool is_refused() const;
  // Time of departure, or of the SEND while no departure is known.
  SimTime at() const { return departure ? *departure : sent.value_or(SimTime()); }
  // Returns the last instant at which the packet is transmitted or received anywhere.
  SimTime end() const;
};

// Return the first and the last instant of a packet at its receiver.
SimTime arrival_of(const packet_outcome_t& outcome);
SimTime end_of(const packet_outcome_t& outcome);

// Packets by name and by number.
class PacketBook {
 public:
  // Times are simulation time. A message that is repeated changes nothing.
  void add(const modem_send_t& send, std::int32_t source_id);
  void add(const modem_receipt_t& receipt, std::int32_t source_id);
  // Returns true when this packet had no outcome at this receiver before. The receivers summed up as out of
  // reach count as one receiver.
  bool add(const packet_outcome_t& outcome);

  // Returns the packets in the order of their first messages.
  const std::deque<PacketRecord>& all() const { return packets_; }
  // Returns the packets that are transmitted or received anywhere within from <= time <= to, sorted by
  // departure.
  std::vector<const PacketRecord*> between(SimTime from, SimTime to) const;
  const PacketRecord* find(std::uint64_t number) const;
  std::size_t outcome_count() const { return outcome_count_; }
  // Returns a number that grows at every change. Packets with a greater revision than a remembered one are
  // new or have changed since.
  std::uint64_t revision() const { return revision_; }

  // Drop the packets that were first met first: as long as they ended before `at`, or until at most `at_most`
  // outcomes are left.
  void drop_before(SimTime at);
  void keep_outcomes(std::size_t at_most);

 private:
  PacketRecord& new_packet(const PacketId& name);
  PacketRecord& touched(PacketRecord& packet);
  PacketRecord& at_number(std::uint64_t number) { return packets_[number - first_]; }
  // Returns the newest packet of that name for which `fits` is true; null when there is none.
  template <class Predicate>
  PacketRecord* newest(const PacketId& name, const Predicate& fits);
  void drop_first();

  std::deque<PacketRecord> packets_;
  std::uint64_t first_ = 0;  // number of the first packet in packets_
  std::map<PacketId, std::vector<std::uint64_t>> numbers_;
  std::size_t outcome_count_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace halocline::clients
