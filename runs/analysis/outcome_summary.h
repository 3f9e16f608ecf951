// SPDX-License-Identifier: BSD-3-Clause
// Summary of a run's packet outcomes: one for each packet at each possible receiver, counted by outcome, pair
// and time.
//
// It is counted from the OUTCOMEs of a log. Each (packet, receiver) counts once, however often its outcome is
// in the log (a recorder may receive a repetition). Outcomes are also counted by the propagation model of
// their paths, which differs within a run where the seabed was not yet known. Vehicles are named by their
// STATE channels, or by their ids when no state was recorded.
#pragma once

#include <compare>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bus/logs/log_reader.h"
#include "bus/messages/messages.h"
#include "runs/plot/plot.h"
#include "runs/timeline/outcome_ledger.h"

namespace halocline::clients {

// Ledger that also keeps the outcomes, without repetitions, and the names of vehicles.
class OutcomeSummary : public OutcomeLedger {
 public:
  using OutcomeLedger::OutcomeLedger;

  // Counts an event of a log. `zero_us` is subtracted from the outcome's times.
  void count(const LoggedEvent& event, std::int64_t zero_us = 0);

  void count(const packet_outcome_t& outcome);

  const std::vector<packet_outcome_t>& outcomes() const { return outcomes_; }
  std::int64_t repeated() const { return repeated_; }  // number of repeated outcomes in the log
  // Returns the name of a vehicle id, or the id as text; "several" for 0, the receivers that one outcome sums
  // up.
  std::string name(std::int32_t vehicle_id) const;
  // Vehicles with a recorded state.
  const std::map<std::int32_t, std::string>& names() const { return names_; }

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

// Prints outcomes, propagations, pairs and windows, each with counts and shares, and for vehicles with
// batteries the energy (energy_cost.h). `coverage` is appended to the number of outcomes, such as ", one for
// each packet and possible receiver".
void print(std::ostream& out, const OutcomeSummary& summary, const std::string& coverage);
// Returns one JSON object: "by_outcome", "by_propagation", "pairs", "windows", and "energy" for vehicles with
// batteries.
std::string to_json(const OutcomeSummary& summary);
// Writes one CSV row for each pair and outcome that occurred: sender, receiver, outcome, packets.
void print_csv(std::ostream& out, const OutcomeSummary& summary);
// Writes one CSV row for each outcome, with the numbers that decided it.
void print_outcomes_csv(std::ostream& out, const OutcomeSummary& summary);

// Returns two charts: bars of the outcomes that occurred, and a line for each of them over the windows of
// time.
Plot outcome_plot(const OutcomeSummary& summary, const std::string& title);

}  // namespace halocline::clients
