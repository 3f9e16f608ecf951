// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/journal_replay.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bus/lockstep/agreement.h"
#include "core/csv_table.h"
#include "core/sim_time.h"

namespace halocline::conductor {
namespace {

std::string text_of(const bus::Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

[[noreturn]] void refuse() { throw std::runtime_error("the journal holds an entry that no conductor wrote"); }

template <class Decoded>
Decoded expected(std::optional<Decoded> decoded) {
  if (!decoded) refuse();
  return std::move(*decoded);
}

std::int64_t number_of(const bus::Bytes& bytes) {
  return expected(parse_number<std::int64_t>(text_of(bytes)));
}

void apply_join(const bus::Bytes& bytes, const std::string& agreement, Sequencer& sequencer) {
  const auto join = expected(bus::decoded<lockstep_join_t>(bytes));
  const std::string other =
      join.scenario_digest.empty() ? "" : bus::disagreement(join.scenario_digest, agreement);
  if (!other.empty())
    throw std::runtime_error("the journal is of another run; remove it or name another: " + other);
  sequencer.admit(join);
}

void apply_round(const bus::Bytes& bytes, bool ending, Sequencer& sequencer) {
  const auto results = expected(bus::decoded_list<lockstep_result_t>(bytes));
  const auto takes_part = [&](const auto& result) { return sequencer.takes_part(result.participant_name); };
  if (results.empty() || !std::all_of(results.begin(), results.end(), takes_part)) refuse();
  while (!sequencer.begin_past_round(results)) {
    const SimTime next = sequencer.next_instant();
    if (ending || next == SimTime::never())
      throw std::runtime_error("the journal has a round after the last");
    sequencer.begin_instant(next);
  }
  sequencer.complete(results);
}

}  // namespace

RunState replay_journal(const std::vector<JournalEntry>& entries, const std::string& agreement,
                        Sequencer& sequencer) {
  RunState run;
  for (const auto& [kind, bytes] : entries) {
    switch (kind) {
      case EntryKind::kRun:
        run.id = number_of(bytes);
        break;
      case EntryKind::kJoin:
        apply_join(bytes, agreement, sequencer);
        break;
      case EntryKind::kRound:
        apply_round(bytes, run.ending, sequencer);
        break;
      case EntryKind::kLeave:
        sequencer.dismiss(text_of(bytes));
        break;
      case EntryKind::kInjected:
        sequencer.inject(expected(bus::decoded<lockstep_message_t>(bytes)));
        break;
      case EntryKind::kEnd:
        sequencer.end_run(SimTime::from_nanoseconds(number_of(bytes)));
        run.ending = true;
        break;
      case EntryKind::kOver:
        run.over = true;
        break;
      default:
        refuse();
    }
  }
  return run;
}

void replay_local(const ParticipantLink& local, const Sequencer& sequencer) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  if (sequencer.turns_taken(local.name) == 0) return;
  std::int64_t digest = 0;
  for (const lockstep_turn_t& turn : sequencer.history_of(local.name, 1, kAll))
    digest = local.take(turn).outputs_digest;
  if (digest != sequencer.digest_of(local.name)) {
    throw std::runtime_error(local.name +
                             " publishes otherwise than in the journal: another scenario or another version");
  }
}

}  // namespace halocline::conductor
