// SPDX-License-Identifier: BSD-3-Clause
// Relay of one vehicle: stores packets of others and forwards them by flooding.
//
// Model: packets are broadcast to all in range. A relay that receives a packet for the first time stores it,
// waits for a random time, and transmits it again while transmissions are left; a vehicle that has already
// had the packet ignores it (controlled flooding: Tanenbaum and Wetherall 2011, Computer Networks, section
// 5.2.3). A packet that the modem refuses because it is transmitting is kept and tried again. The destination
// may confirm a packet by one of its own, which returns in the same way. The wait is uniform between 0 and
// `longest_wait`, drawn from seed, vehicle and packet, so that two relays that received the same packet do
// not transmit it at once. Bounds: kMaxStored stored packets, the latest kMaxKnown names of packets,
// kMaxTries attempts of a transmission. There are no routes and no acknowledgements between neighbours. The
// relay does no input or output of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "clients/onboard/traffic/relay_packet.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct RelayRules {
  bool passes_on = false;  // forwards packets of others
  int hops = 1;            // transmissions of own packets from end to end, 1 to RelayPacket::kMaxHops
  bool confirmed = false;  // own packets to one vehicle are to be confirmed
  SimDuration longest_wait = SimDuration::from_milliseconds(2000);  // 0 and up
};

struct RelayCounters {
  std::int64_t originated = 0;  // own packets, each once
  std::int64_t delivered = 0;   // packets of others to this vehicle or to all, each once
  std::int64_t confirmed = 0;   // own packets whose confirmation arrived
  std::int64_t passed_on = 0;   // transmissions of packets of others that the modem accepted
  std::int64_t duplicates = 0;  // packets that arrived again
  std::int64_t expired = 0;     // packets of others without a transmission left
  std::int64_t retried = 0;     // refused by a busy modem, and kept
  std::int64_t dropped = 0;     // too many stored, too many tries, or impossible for the modem
  void add(const RelayCounters& other);
};

class Relay {
 public:
  static constexpr std::size_t kMaxStored = 100, kMaxKnown = 1000;
  static constexpr int kMaxTries = 20;

  // `vehicle_id`: the vehicle that relays. `seed` determines the waits.
  Relay(std::int32_t vehicle_id, RelayRules rules, std::uint64_t seed);

  // Receives each packet of others that is delivered to this vehicle, once.
  using DeliveryHandler = std::function<void(const RelayPacket&, SimTime at)>;
  void on_delivery(DeliveryHandler handler) { delivery_handler_ = std::move(handler); }

  // Stores an own packet, to be transmitted at `at`.
  void originate(std::int32_t destination, std::vector<std::uint8_t> payload, SimTime at);
  // Takes the payload of a packet that arrived at `at`; one without the header of relays is ignored.
  void take(std::span<const std::uint8_t> bytes, SimTime at);

  // Returns when the next stored packet is to be transmitted; never() without one.
  SimTime next() const;
  // Returns the earliest stored packet that is due at `now`, to be broadcast. The caller then calls
  // on_sent(), and on_receipt() when the modem has answered.
  struct Transmission {
    SimTime at;
    std::vector<std::uint8_t> bytes;
  };
  std::optional<Transmission> transmit_due(SimTime now);
  // Sets the modem's packet_sequence of the latest transmission.
  void on_sent(std::int64_t packet_sequence);
  enum class Verdict { kAccepted, kBusy, kImpossible };
  void on_receipt(std::int64_t packet_sequence, Verdict verdict, SimTime at);

  // Moves the transmission of all stored packets by `by`, because the clock that tells their times was set.
  void move(SimDuration by);

  // Forgets all stored packets for another run.
  void clear();

  const RelayCounters& counters() const { return counters_; }
  const RelayRules& rules() const { return rules_; }
  void archive(Archive& a);
  // Returns a number that increases with each change of the archived state.
  std::uint64_t changes() const { return changes_; }

 private:
  struct Stored {
    SimTime at;
    RelayPacket packet;
    int tries = 0;
    std::int64_t packet_sequence = 0;  // number given by the modem, once transmitted
    void archive(Archive& a) { a(at, packet, tries, packet_sequence); }
  };
  using Name = std::tuple<std::int32_t, std::int32_t, bool, std::uint16_t>;

  void store(RelayPacket packet, SimTime at, int tries);
  [[nodiscard]] bool is_new(const Name& name);
  void deliver(const RelayPacket& packet, SimTime at);
  SimDuration wait_before(const RelayPacket& packet, int tries) const;

  std::int32_t vehicle_id_;
  RelayRules rules_;
  std::uint64_t seed_;
  DeliveryHandler delivery_handler_;
  RelayCounters counters_;
  std::uint64_t changes_ = 0;
  std::uint16_t next_number_ = 0;
  std::vector<Stored> stored_;
  std::optional<Stored> in_hand_;    // last result of transmit_due(), until on_sent()
  std::vector<Stored> transmitted_;  // packets without a receipt yet
  std::set<Name> known_;
  std::deque<Name> known_in_order_;
};

}  // namespace halocline::clients
