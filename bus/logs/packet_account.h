// SPDX-License-Identifier: BSD-3-Clause
// Accepted transmissions of a log, and whether each has its outcomes.
//
// Rule (packet_medium.h): a transmission that a RECEIPT accepts has an OUTCOME at every vehicle with a modem
// that was there at its departure, but the sender. A vehicle was there when its STATEs had begun a second
// before the departure, had gone on until then without a silence, and go on after it; it has a modem when it
// sends, receives or has LINKS in the log. That is fewer than the server knows, so that no whole log is
// blamed. Packets that may still have been on their way at the end of the log are left out: their time is the
// packet's duration, and the longest delay of an outcome that the log holds or that its vehicles are apart.
// So are those that a vehicle with a battery had queued: it may have run out. Where CLOCK goes back by more
// than ten seconds another run begins, and the one before is judged by itself.
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

#include "bus/messages.h"

namespace halocline::clients {

class PacketAccount {
 public:
  PacketAccount() = default;
  PacketAccount(PacketAccount&&) = default;  // packets point to vehicles, which stay where they are
  PacketAccount& operator=(PacketAccount&&) = default;

  // Messages in the order of the log; `vehicle` is the name that the channel has. Repetitions change nothing.
  void take(std::string_view vehicle, const vehicle_state_t& state);
  void take(std::string_view vehicle, const vehicle_battery_t& battery);
  void take(std::string_view vehicle, const modem_send_t& send);
  void take(std::string_view vehicle, const modem_receipt_t& receipt);
  void take(std::string_view vehicle, const packet_outcome_t& outcome);
  void take(std::string_view vehicle, const link_table_t& links);
  void take(std::string_view vehicle, const sim_clock_t& clock);

  struct Missing {
    std::int64_t accepted = 0;          // packets
    std::int64_t under_way = 0;         // of these, perhaps, at the end of the log
    std::int64_t without_outcome = 0;   // of the others
    std::int64_t lack_some = 0;         // of the others: packets that have outcomes, but not at every vehicle
    std::int64_t outcomes_lacking = 0;  // of these packets
    bool any() const { return without_outcome > 0 || lack_some > 0; }
  };
  Missing missing() const;

 private:
  using Ids = std::vector<std::int32_t>;  // ascending
  struct Vehicle {
    std::optional<std::int32_t> id;
    std::int64_t since_us = 0, last_us = 0;  // of its STATEs without a silence
    bool has_state = false, has_battery = false, has_sent = false;
  };
  // One transmission of one sender.
  struct Name {
    std::int64_t session = 0, sequence = 0, departure_us = 0;
    auto operator<=>(const Name&) const = default;
  };
  struct Packet {
    const Vehicle* sender = nullptr;
    double duration_s = 0;
    std::shared_ptr<const Ids> there;  // at its departure, as far as the log had come
  };
  struct Outcomes {
    std::int32_t source_id = 0;
    Ids receivers;
    std::int64_t several = 0;  // receivers that one outcome sums up
  };

  Vehicle& vehicle(std::string_view name, std::int32_t id);
  bool has_modem(std::int32_t id) const { return with_modem_.contains(id); }
  std::shared_ptr<const Ids> vehicles_there(std::int64_t departure_us);
  Ids receivers_of(const Packet& packet, std::int64_t departure_us) const;
  bool has_possible_receiver(const Packet& packet) const;
  const Outcomes* outcomes_of(const Name& name, const Vehicle& sender) const;
  double longest_delay_s() const;

  std::map<std::string, Vehicle, std::less<>> vehicles_;
  std::set<std::int32_t> with_modem_;  // of OUTCOMEs and LINKS
  std::map<std::pair<Name, const Vehicle*>, Packet> packets_;
  std::map<Name, std::vector<Outcomes>> outcomes_;  // by source
  std::shared_ptr<const Ids> there_;                // the latest; most packets share it
  std::int64_t end_us_ = INT64_MIN;
  std::optional<std::int64_t> clock_us_;
  Missing settled_;  // of the runs before
  double longest_delay_s_ = 0;
  double least_ned_m_[3] = {1e9, 1e9, 1e9}, greatest_ned_m_[3] = {-1e9, -1e9, -1e9};
};

}  // namespace halocline::clients
