// SPDX-License-Identifier: BSD-3-Clause
// The receipt of each transmission requested, so that a repetition is answered, not transmitted again; and
// the intervals in which each modem is occupied.
//
// A modem that queues sends one after the other, in the order of their starts: the next one when all accepted
// before have ended.
//
// A request's name is (vehicle, session, packet_sequence); of a sender that keeps no session (0) also the
// start, because its numbers may begin anew. Nothing is ever transmitted twice: a request is known for as
// long as its start may be accepted; beyond that kMaxOld are kept for kOldAge, 3 MB at most, so that who
// repeats a SEND late is told what became of it.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "channel_server/packets/packet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

struct RequestName {
  std::string vehicle;
  std::int64_t session = 0;
  std::int64_t packet_sequence = 0;
  SimTime start;  // 0 for senders that keep a session

  auto operator<=>(const RequestName&) const = default;
};
RequestName name_of(const SendRequest& request);

class SendRegister {
 public:
  // Of more packets the earliest starts are forgotten.
  static constexpr std::size_t kMaxPackets = 100'000;
  // Packets that stay known when their starts are too old to be accepted.
  static constexpr std::size_t kMaxOld = 10'000;
  static constexpr SimDuration kOldAge = SimDuration::from_nanoseconds(600'000'000'000);

  // True for a packet that is new; it is known from now on, its receipt outstanding.
  [[nodiscard]] bool enter(const SendRequest& request);
  void decide(const SendRequest& request, const Receipt& receipt);
  // Null while undecided.
  const Receipt* receipt_of(const SendRequest& request) const;

  // True when the modem is occupied at any time of [start, start + duration).
  bool is_busy(const std::string& vehicle, SimTime start, SimDuration duration) const;
  // When a modem that queues is free for a transmission requested for `start`: never before it.
  SimTime free_from(const std::string& vehicle, SimTime start) const;
  // Transmissions accepted that have not started at `instant`.
  std::size_t waiting_at(const std::string& vehicle, SimTime instant) const;
  void occupy(const std::string& vehicle, SimTime start, SimDuration duration);

  // No request that starts before `time` is accepted any more.
  void forget_before(SimTime time);
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    SimTime start;
    bool decided = false;
    Receipt receipt;
  };
  struct Occupation {
    SimTime start, end;
  };
  void forget_earliest();

  std::map<RequestName, Entry> entries_;
  std::set<std::pair<SimTime, RequestName>> by_start_;
  std::map<std::string, std::vector<Occupation>> occupations_;
};

}  // namespace halocline::channel_server
