// SPDX-License-Identifier: BSD-3-Clause
// The packets of a mission: each transmission with its SEND, its receipt and its outcome at every receiver,
// joined by name.
//
// A packet's name is its sender's id, session, sequence and kind. Where a name was used more than once (a
// publisher without sessions that was started again), transmissions differ by their departure. Any part may
// be missing or come first: a log may begin late, the answer to a ping has no SEND.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "bus/messages.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct PacketName {
  std::int32_t source_id = 0;
  std::int8_t kind = 0;  // packet_outcome_t.packet_kind
  std::int64_t session = 0, sequence = 0;
  auto operator<=>(const PacketName&) const = default;
};

struct PacketRecord {
  std::uint64_t number = 0;  // in the order in which packets were met; stays as it is
  PacketName name;
  std::int32_t destination_id = 0;     // 0: all
  std::optional<SimTime> sent;         // its SEND's time; empty: none was met
  std::int32_t payload_bytes = -1;     // -1: not known
  std::optional<std::int8_t> receipt;  // modem_receipt_t.ACCEPTED, ...; empty: none was met
  std::optional<SimTime> departure;    // empty: refused, or not known yet
  double duration_s = 0;
  std::vector<packet_outcome_t> outcomes;  // by the receiver's id; one each
  std::int64_t out_of_reach = 0;           // other receivers, summed up in one OUTCOME
  std::uint64_t revision = 0;              // PacketBook::revision() of the last change

  bool is_refused() const;
  // Departure, or when it was to be sent.
  SimTime at() const { return departure ? *departure : sent.value_or(SimTime()); }
  // The last instant at which something of it is on its way.
  SimTime end() const;
};

// First and last instant of a packet at its receiver.
SimTime arrival_of(const packet_outcome_t& outcome);
SimTime end_of(const packet_outcome_t& outcome);

class PacketBook {
 public:
  // Times are those of the mission. A repetition changes nothing.
  void add(const modem_send_t& send, std::int32_t source_id);
  void add(const modem_receipt_t& receipt, std::int32_t source_id);
  // True when this (packet, receiver) had no outcome before; the receivers that are summed up count as one.
  bool add(const packet_outcome_t& outcome);

  // In the order in which they were met.
  const std::deque<PacketRecord>& all() const { return packets_; }
  // Those with departure or reception within from <= time <= to, by departure.
  std::vector<const PacketRecord*> between(SimTime from, SimTime to) const;
  const PacketRecord* find(std::uint64_t number) const;
  std::size_t outcome_count() const { return outcome_count_; }
  // Grows at every change; packets with a greater revision than the one remembered are new or have changed.
  std::uint64_t revision() const { return revision_; }

  // Drops the oldest, in the order in which they were met: those over before `at`; or until at most so many
  // outcomes are left.
  void drop_before(SimTime at);
  void keep_outcomes(std::size_t at_most);

 private:
  PacketRecord& new_packet(const PacketName& name);
  PacketRecord& touched(PacketRecord& packet);
  PacketRecord& at_number(std::uint64_t number) { return packets_[number - first_]; }
  // The newest packet of that name for which `fits` holds; null when there is none.
  template <class Predicate>
  PacketRecord* newest(const PacketName& name, const Predicate& fits);
  void drop_first();

  std::deque<PacketRecord> packets_;
  std::uint64_t first_ = 0;  // number of the first of them
  std::map<PacketName, std::vector<std::uint64_t>> numbers_;
  std::size_t outcome_count_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace halocline::clients
