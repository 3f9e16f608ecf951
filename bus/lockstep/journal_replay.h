// SPDX-License-Identifier: BSD-3-Clause
// Restores the state of a lockstep run from the journal of an earlier incarnation of its conductor.
#pragma once

#include <string>
#include <vector>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/membership.h"
#include "bus/lockstep/participant_links.h"
#include "bus/lockstep/sequencer.h"

namespace halocline::conductor {

// Applies the entries to a new sequencer, which publishes the messages of the run again. Throws
// std::runtime_error for a journal of another run (different `agreement`, agreement.h), and for entries that
// no conductor wrote.
RunState replay_journal(const std::vector<JournalEntry>& entries, const std::string& agreement,
                        Sequencer& sequencer);

// Makes a local participant take its turns again. Throws std::runtime_error when its messages differ from
// those of the journal.
void replay_local(const ParticipantLink& local, const Sequencer& sequencer);

}  // namespace halocline::conductor
