// SPDX-License-Identifier: BSD-3-Clause
// Comparison of two logs of one scenario: the packets whose outcome changed, and the inputs of the decision
// that differ.
//
// A packet at a receiver is matched with the other log by its name (sender, kind, session, sequence),
// destination and receiver. A name that was used more than once is matched by the instant of departure, and
// in order where that moved. When one log has no outcome for it, the receipt of its transmission may give the
// reason (refused), or the log ended before, or the log holds no outcomes at all (a run recorded at sea).
//
// `moved` names the inputs of the decision that differ: level, noise, interference, paths, propagation,
// range, duration, cutoff, doppler, draws, colliders. Levels count as different from 0.05 dB on, ranges from
// 0.1 m, Doppler factors from 1e-6, durations from 1 us, all others at any difference; anything smaller is
// rounding.
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
#include "runs/analysis/outcome_summary.h"

namespace halocline::clients {

struct LoggedOutcomes {
  OutcomeSummary summary{60'000'000};
  // Results of receipts, keyed by the vehicle's name, the session and the sequence.
  std::map<std::tuple<std::string, std::int64_t, std::int64_t>, std::int8_t> receipts;
  std::int64_t sends = 0;      // number of SENDs in the log
  std::int64_t end_utime = 0;  // time of the last outcome or receipt
};

// Reads the outcomes of a log. `zero_us` is subtracted from the times of all messages, for a log that a
// replay shifted.
LoggedOutcomes outcomes_of(LogReader& log, std::int64_t zero_us = 0);

// Matched outcomes of two logs and the differences between them.
class Comparison {
 public:
  struct Row {
    std::optional<packet_outcome_t> before, after;  // at least one is present
    std::string outcome_before, outcome_after;
    std::vector<std::string> moved;  // inputs that differ; empty unless both outcomes are present
    std::string why;                 // sentence on the cause; empty when the outcome is the same

    bool changed() const { return outcome_before != outcome_after; }
    const packet_outcome_t& any() const { return before ? *before : *after; }
  };

  // Compares two logs. The names of their vehicles must agree, as in logs of one scenario.
  Comparison(const LoggedOutcomes& before, const LoggedOutcomes& after);

  const std::vector<Row>& rows() const { return rows_; }  // sorted by departure, sender, sequence, receiver
  bool anything_before() const { return anything_before_; }
  // Returns the number of (packet, receiver) pairs for each change from one outcome to another; unchanged
  // ones have the same outcome twice.
  const std::map<std::pair<std::string, std::string>, std::int64_t>& transitions() const {
    return transitions_;
  }
  // Returns how often each input differed among the changed packets.
  const std::map<std::string, std::int64_t>& moved_inputs() const { return moved_inputs_; }
  std::int64_t changed() const { return changed_; }
  // Returns the number of pairs whose outcomes agree in every number, as in a repetition of the run.
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

// Prints totals, transitions, inputs that moved, and the first changed packets.
void print(std::ostream& out, const Comparison& comparison);
// Returns one JSON object: totals, "transitions", "moved", and "rows" with every changed packet and the
// numbers of both outcomes.
std::string to_json(const Comparison& comparison);
// Writes one CSV row for each packet and receiver, changed or not.
void print_csv(std::ostream& out, const Comparison& comparison);

}  // namespace halocline::clients
