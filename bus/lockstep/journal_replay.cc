#include "bus/lockstep/journal_replay.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/sim_time.h"

namespace halocline::conductor {
namespace {

std::string text_of(const bus::Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

template <class Decoded>
Decoded expected(std::optional<Decoded> decoded) {
  if (!decoded) throw std::runtime_error("the journal holds an entry that no conductor wrote");
  return std::move(*decoded);
}

void apply_join(const bus::Bytes& bytes, const std::string& scenario_digest, Sequencer& sequencer) {
  const auto join = expected(bus::decoded<lockstep_join_t>(bytes));
  if (!join.scenario_digest.empty() && join.scenario_digest != scenario_digest)
    throw std::runtime_error("the journal is of another scenario; remove it or name another");
  sequencer.admit(join);
}

void apply_round(const bus::Bytes& bytes, bool ending, Sequencer& sequencer) {
  const auto results = expected(bus::decoded_list<lockstep_result_t>(bytes));
  while (!sequencer.begin_past_round(results)) {
    if (ending) throw std::runtime_error("the journal has a round after the last");
    sequencer.begin_instant(sequencer.next_instant());
  }
  sequencer.complete(results);
}

}  // namespace

RunState replay_journal(const std::vector<JournalEntry>& entries, const std::string& scenario_digest,
                        Sequencer& sequencer) {
  RunState run;
  for (const auto& [kind, bytes] : entries) {
    switch (kind) {
      case EntryKind::kRun:
        run.id = std::stoll(text_of(bytes));
        break;
      case EntryKind::kJoin:
        apply_join(bytes, scenario_digest, sequencer);
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
        sequencer.end_run(SimTime::from_nanoseconds(std::stoll(text_of(bytes))));
        run.ending = true;
        break;
      case EntryKind::kOver:
        run.over = true;
        break;
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
