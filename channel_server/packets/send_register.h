// SPDX-License-Identifier: BSD-3-Clause
// A register of the receipts of all requested transmissions, so that a repeated request is answered and not
// transmitted again, and of the intervals in which each modem is occupied.
//
// A modem that queues sends its packets one after the other, in the order of their starts: the next begins
// when all accepted before it have ended.
//
// A request's name is (vehicle, session, packet_sequence). For a sender that keeps no session (0) the start
// is part of the name, because its sequence numbers may begin again. Nothing is ever transmitted twice: a
// request is known for as long as its start may be accepted. After that kMaxOld requests (3 MB at most) are
// kept for kOldAge, so that a sender that repeats its request (SEND) late gets the receipt of the first.
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

// The name by which a repeated request is recognised.
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
  // The largest number of packets known; beyond it those with the earliest starts are forgotten.
  static constexpr std::size_t kMaxPackets = 100'000;
  // The largest number of packets that stay known although their starts are too old to be accepted.
  static constexpr std::size_t kMaxOld = 10'000;
  static constexpr SimDuration kOldAge = SimDuration::from_nanoseconds(600'000'000'000);

  // Returns true for a new request, which is known from now on and has no receipt yet.
  [[nodiscard]] bool enter(const SendRequest& request);
  // Stores the receipt of a request; does nothing when the request is not known any more.
  void decide(const SendRequest& request, const Receipt& receipt);
  // Returns null while the request is undecided, or when it is not known.
  const Receipt* receipt_of(const SendRequest& request) const;

  // True when the modem transmits during any part of [start, start + duration).
  bool is_busy(const std::string& vehicle, SimTime start, SimDuration duration) const;
  // Returns when a modem that queues is free for a transmission requested for `start`; at least `start`.
  SimTime free_from(const std::string& vehicle, SimTime start) const;
  // Returns the number of accepted transmissions that have not started at `instant`.
  std::size_t waiting_at(const std::string& vehicle, SimTime instant) const;
  // Marks the modem as transmitting during [start, start + duration).
  void occupy(const std::string& vehicle, SimTime start, SimDuration duration);

  // Declares that no request with a start before `time` is accepted any more.
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
