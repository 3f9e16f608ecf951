// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_log.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "bus/config/scenario.h"
#include "bus/messages/messages.h"
#include "runs/analysis/outcome_summary.h"

namespace halocline::clients {
namespace {

constexpr double kSameRangeShare = 0.1, kSameRangeM = 20;
constexpr std::int64_t kWindowUs = 60'000'000;  // of the summary's own counts, which are not used

// True when the outcome tells how well the sea carries packets.
bool tells_of_the_sea(const packet_outcome_t& outcome) {
  using Outcome = packet_outcome_t;
  switch (outcome.outcome) {
    case Outcome::RECEIVER_GONE:
    case Outcome::OUT_OF_BAND:
    case Outcome::COLLIDED:
    case Outcome::HALF_DUPLEX:
    case Outcome::FOREIGN:
    case Outcome::ASLEEP:
    case Outcome::EXTRA_LOSS:
    case Outcome::NO_POWER:
      return false;
    default:
      return outcome.receiver_id != 0;
  }
}

}  // namespace

TrialLog read_trial_log(LogReader& log, const ScenarioConfig& config) {
  const OutcomeSummary summary = summary_of(log, kWindowUs);
  TrialLog trial;
  std::size_t moved = 0, unknown = 0;
  for (const packet_outcome_t& outcome : summary.outcomes()) {
    if (!tells_of_the_sea(outcome)) continue;
    const std::string from = summary.name(outcome.source_id), to = summary.name(outcome.receiver_id);
    const bus::VehicleEntry *sender = config.scenario.find(from), *receiver = config.scenario.find(to);
    if (sender == nullptr || receiver == nullptr) {
      ++unknown;
      continue;
    }
    const double start_m = (receiver->start_ned_m - sender->start_ned_m).norm();
    if (std::abs(outcome.range_m - start_m) > std::max(kSameRangeShare * start_m, kSameRangeM)) {
      ++moved;
      continue;
    }
    trial.rows.push_back({.time_s = 1e-6 * static_cast<double>(outcome.departure_utime),
                          .from = from,
                          .to = to,
                          .sent = 1,
                          .received = outcome.outcome == packet_outcome_t::RECEIVED ? 1 : 0});
  }
  if (moved > 0)
    trial.notes.push_back(
        std::to_string(moved) +
        " packets are left out: their vehicles had moved from where the scenario starts them");
  if (unknown > 0)
    trial.notes.push_back(std::to_string(unknown) +
                          " packets are left out: the scenario has no such vehicles");
  return trial;
}

}  // namespace halocline::clients
