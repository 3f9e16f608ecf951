// SPDX-License-Identifier: BSD-3-Clause
// Account of the accepted transmissions of a log: checks that each has its outcomes.
//
// Rule (packet_medium.h): a transmission that a RECEIPT accepts has an OUTCOME at every vehicle with a modem
// that was present at its departure, except the sender. A vehicle was present if its STATEs had begun at
// least a second before the departure, had continued until then without a silence, and continue after it. It
// has a modem if it sends, receives or has LINKS in the log. This finds fewer vehicles than the server knows,
// so that no complete log is reported as faulty.
//
// Packets that may still have been under way at the end of the log are left out. Their time is the packet's
// duration plus a delay: the longest one of an outcome in the log, or that of the distance between its
// vehicles if longer. Packets that a vehicle with a battery had queued are left out, too, as its battery may
// have run out. If CLOCK goes back by more than ten seconds, another run begins, and the previous one is
// judged separately.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::clients {

class PacketAccount {
 public:
  PacketAccount() = default;
  PacketAccount(PacketAccount&&) = default;  // packets point to vehicles, which do not move
  PacketAccount& operator=(PacketAccount&&) = default;

  // Processes a message; call it in the order of the log. `vehicle` is the name in the channel. Repeated
  // messages change nothing.
  void take(std::string_view vehicle, const vehicle_state_t& state);
  void take(std::string_view vehicle, const vehicle_battery_t& battery);
  void take(std::string_view vehicle, const modem_send_t& send);
  void take(std::string_view vehicle, const modem_receipt_t& receipt);
  void take(std::string_view vehicle, const packet_outcome_t& outcome);
  void take(std::string_view vehicle, const link_table_t& links);
  void take(std::string_view vehicle, const sim_clock_t& clock);

  struct Missing {
    std::int64_t accepted = 0;          // packets
    std::int64_t under_way = 0;         // accepted packets perhaps still under way at the end of the log
    std::int64_t without_outcome = 0;   // other packets without any outcome
    std::int64_t lack_some = 0;         // other packets with outcomes, but not at every vehicle
    std::int64_t outcomes_lacking = 0;  // number of outcomes missing for the lack_some packets
    bool any() const { return without_outcome > 0 || lack_some > 0; }
  };
  Missing missing() const;

 private:
  using Ids = std::vector<std::int32_t>;  // ascending
  struct Vehicle {
    std::optional<std::int32_t> id;
    std::int64_t since_us = 0, last_us = 0;  // first and last of its STATEs without a silence
    bool has_state = false, has_battery = false, has_sent = false;
  };
  // Identifies one transmission of one sender.
  struct Name {
    std::int64_t session = 0, sequence = 0, departure_us = 0;
    auto operator<=>(const Name&) const = default;
  };
  struct Packet {
    const Vehicle* sender = nullptr;
    double duration_s = 0;
    std::shared_ptr<const Ids> there;  // present at its departure, as far as the log was read
  };
  struct Outcomes {
    std::int32_t source_id = 0;
    Ids receivers;
    std::int64_t several = 0;  // number of receivers in a common outcome
  };

  Vehicle& vehicle(std::string_view name, std::int32_t id);
  bool has_modem(std::int32_t id) const { return with_modem_.contains(id); }
  std::shared_ptr<const Ids> vehicles_there(std::int64_t departure_us);
  Ids receivers_of(const Packet& packet, std::int64_t departure_us) const;
  bool has_possible_receiver(const Packet& packet) const;
  const Outcomes* outcomes_of(const Name& name, const Vehicle& sender) const;
  double longest_delay_s() const;

  std::map<std::string, Vehicle, std::less<>> vehicles_;
  std::set<std::int32_t> with_modem_;  // from OUTCOMEs and LINKS
  std::map<std::pair<Name, const Vehicle*>, Packet> packets_;
  std::map<Name, std::vector<Outcomes>> outcomes_;  // elements differ by source
  std::shared_ptr<const Ids> there_;                // the latest; most packets share it
  std::int64_t end_us_ = INT64_MIN;
  std::optional<std::int64_t> clock_us_;
  Missing settled_;  // result of earlier runs in the log
  double longest_delay_s_ = 0;
  double least_ned_m_[3] = {1e9, 1e9, 1e9}, greatest_ned_m_[3] = {-1e9, -1e9, -1e9};
};

}  // namespace halocline::clients
