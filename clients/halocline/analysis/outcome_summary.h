// SPDX-License-Identifier: BSD-3-Clause
// The packet outcomes of a run: one for every packet at every possible receiver, counted by outcome, pair and
// time.
//
// Counted from the OUTCOMEs of a log; each (packet, receiver) counts once, however often its outcome stands
// in the log (a recorder may receive a repetition). Counted by what their paths were computed with as well:
// packets of one run differ in it where the seabed was not known to some. Vehicles go by the names of their
// STATE channels, or by their ids where no state was recorded.
#pragma once

#include <compare>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "bus/messages.h"
#include "clients/halocline/plot/plot.h"
#include "clients/mission/outcome_ledger.h"

namespace halocline::clients {

class OutcomeSummary : public OutcomeLedger {
 public:
  using OutcomeLedger::OutcomeLedger;

  // `zero_us` is taken off the outcome's times.
  void count(const LoggedEvent& event, std::int64_t zero_us = 0);

  void count(const packet_outcome_t& outcome);

  // In the order of the log.
  const std::vector<packet_outcome_t>& outcomes() const { return outcomes_; }
  std::int64_t repeated() const { return repeated_; }  // outcomes that the log holds more than once
  // Of a vehicle id: its name, or the id as text; "several" of 0, receivers that one outcome sums up.
  std::string name(std::int32_t vehicle_id) const;
  const std::map<std::int32_t, std::string>& names() const { return names_; }  // of the vehicles with a state

 private:
  struct Key {
    std::int32_t source_id, receiver_id, destination_id;
    std::int64_t send_session, packet_sequence, departure_utime;
    std::int8_t packet_kind;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<packet_outcome_t> outcomes_;
  std::map<std::int32_t, std::string> names_;
  std::set<Key> counted_;
  std::int64_t repeated_ = 0;
};

OutcomeSummary summary_of(LogReader& log, std::int64_t window_us);

// As text, `coverage` behind the number of outcomes, ", one for each packet and possible receiver": outcomes,
// propagations, pairs, windows, each with counts and shares; where vehicles have batteries, energy
// (energy_cost.h).
void print(std::ostream& out, const OutcomeSummary& summary, const std::string& coverage);
// One object: "by_outcome", "by_propagation", "pairs", "windows", and "energy" where vehicles have batteries.
std::string to_json(const OutcomeSummary& summary);
// One row a pair and outcome that occurred: sender, receiver, outcome, packets.
void print_csv(std::ostream& out, const OutcomeSummary& summary);
// One row an outcome, with the numbers that decided it.
void print_outcomes_csv(std::ostream& out, const OutcomeSummary& summary);

// Two charts: bars of the outcomes that occurred; lines of each of these over the windows of time.
Plot outcome_plot(const OutcomeSummary& summary, const std::string& title);

}  // namespace halocline::clients
