// SPDX-License-Identifier: BSD-3-Clause
// Two logs of one mission side by side: which packets changed their outcome, and the inputs that differ.
//
// A packet at a receiver is found again in the other log by its name (sender, kind, session, sequence),
// destination and receiver; where a name was used more than once, by the instant of departure, and by turn
// where that moved. Where one log has no outcome for it, the receipt of its transmission may give the reason
// (refused), or the log ended before, or the log holds no outcomes at all (a mission recorded at sea).
//
// `moved` names the inputs of the decision that differ: level, noise, interference, paths, propagation,
// range, duration, cutoff, doppler, draws, colliders. Levels by 0.05 dB, ranges by 0.1 m, Doppler factors by
// 1e-6, durations by 1 us, others at all; a difference below that is rounding's.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/logs/log_reader.h"
#include "clients/halocline/analysis/outcome_summary.h"

namespace halocline::clients {

// The outcomes and receipts in a log.
struct LoggedOutcomes {
  OutcomeSummary summary{60'000'000};
  // By vehicle's name, session and sequence: the receipt's result.
  std::map<std::tuple<std::string, std::int64_t, std::int64_t>, std::int8_t> receipts;
  std::int64_t sends = 0;      // SENDs in the log
  std::int64_t end_utime = 0;  // of the last outcome or receipt
};

// `zero_us` is taken off the times of all messages: where a replay moved them.
LoggedOutcomes outcomes_of(LogReader& log, std::int64_t zero_us = 0);

class Comparison {
 public:
  struct Row {
    std::optional<packet_outcome_t> before, after;  // one at least
    std::string outcome_before, outcome_after;
    std::vector<std::string> moved;  // inputs that differ; empty unless both are there
    std::string why;                 // a sentence; empty when the outcome is the same

    bool changed() const { return outcome_before != outcome_after; }
    const packet_outcome_t& any() const { return before ? *before : *after; }
  };

  // The names of vehicles must agree, as in logs of one mission.
  Comparison(const LoggedOutcomes& before, const LoggedOutcomes& after);

  const std::vector<Row>& rows() const { return rows_; }  // by departure, sender, sequence, receiver
  bool anything_before() const { return anything_before_; }
  // How many (packet, receiver) went from one outcome to another; unchanged ones are on the diagonal.
  const std::map<std::pair<std::string, std::string>, std::int64_t>& transitions() const {
    return transitions_;
  }
  // Of the changed: how often an input differed.
  const std::map<std::string, std::int64_t>& moved_inputs() const { return moved_inputs_; }
  std::int64_t changed() const { return changed_; }
  // The two outcomes are the same in every number: a repetition of the run.
  std::int64_t identical() const { return identical_; }
  std::string name(std::int32_t vehicle_id) const;

 private:
  void add(const LoggedOutcomes& before, const LoggedOutcomes& after, const packet_outcome_t* was,
           const packet_outcome_t* is);

  std::vector<Row> rows_;
  std::map<std::pair<std::string, std::string>, std::int64_t> transitions_;
  std::map<std::string, std::int64_t> moved_inputs_;
  std::map<std::int32_t, std::string> names_;
  bool anything_before_ = true;
  std::int64_t changed_ = 0, identical_ = 0;
};

// For a person: totals, transitions, what moved, and the first changed packets.
void print(std::ostream& out, const Comparison& comparison);
// One object: totals, "transitions", "moved", and "rows": every changed packet with the numbers of both
// outcomes.
std::string to_json(const Comparison& comparison);
// One row a packet and receiver, changed or not.
void print_csv(std::ostream& out, const Comparison& comparison);

}  // namespace halocline::clients
