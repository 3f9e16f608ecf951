// How a conductor takes up the run of its earlier life from the journal (lockstep_conductor.h).
#include <algorithm>
#include <stdexcept>

#include "bus/lockstep/lockstep_conductor.h"

namespace halocline::conductor {
namespace {

std::string text_of(const bus::Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

template <class Decoded>
Decoded expected(std::optional<Decoded> decoded) {
  if (!decoded) throw std::runtime_error("the journal holds an entry that no conductor wrote");
  return std::move(*decoded);
}

}  // namespace

void LockstepConductor::resume(const std::vector<JournalEntry>& entries) {
  for (const JournalEntry& entry : entries) apply(entry);
  for (auto& [name, link] : links_) {
    if (link.take) replay_local(name, link);
  }
  mouth_.report("resumed", "t=" + std::to_string(sequencer_.now().seconds()) +
                               " rounds=" + std::to_string(sequencer_.rounds()));
}

void LockstepConductor::apply(const JournalEntry& entry) {
  switch (entry.kind) {
    case EntryKind::kRun:
      run_id_ = std::stoll(text_of(entry.bytes));
      return;
    case EntryKind::kJoin: {
      const auto join = expected(bus::decoded<lockstep_join_t>(entry.bytes));
      sequencer_.admit(join);
      links_[join.participant_name].wants_in = false;
      return;
    }
    case EntryKind::kRound:
      return apply_round(entry.bytes);
    case EntryKind::kFarewell:
      sequencer_.let_go(text_of(entry.bytes));
      return;
    case EntryKind::kOutside:
      return sequencer_.hear_from_outside(expected(bus::decoded<lockstep_message_t>(entry.bytes)));
    case EntryKind::kEnd:
      ending_ = true;
      return sequencer_.end_run(SimTime::from_nanoseconds(std::stoll(text_of(entry.bytes))));
    case EntryKind::kOver:
      over_ = true;
  }
}

void LockstepConductor::apply_round(const bus::Bytes& bytes) {
  while (!sequencer_.begin_round()) {
    if (ending_) throw std::runtime_error("the journal has a round after the last");
    sequencer_.begin_instant(sequencer_.next_instant());
  }
  sequencer_.complete(expected(bus::decoded_list<lockstep_result_t>(bytes)));
}

void LockstepConductor::replay_local(const std::string& name, Link& link) {
  constexpr std::size_t kAll = ~std::size_t{0};
  std::int64_t digest = 0;
  if (sequencer_.turns_taken(name) == 0) return;
  for (const lockstep_turn_t& turn : sequencer_.past_turns(name, 1, kAll))
    digest = link.take(turn).outputs_digest;
  if (digest != sequencer_.digest_of(name))
    throw std::runtime_error(name +
                             " says otherwise than in the journal: another scenario or another version");
}

}  // namespace halocline::conductor
