// SPDX-License-Identifier: BSD-3-Clause
// Write-ahead journal of the conductor: the inputs of its sequencer in order, from which a new incarnation
// continues the run.
//
// The file consists of records (bus/recovery/journal_file.h) that hold LCM-encoded messages. Each entry is
// handed to the kernel before anything that depends on it is sent, so a killed process loses nothing that
// anybody acted upon; a machine that loses power may (no fsync). An entry that a kill cut off is removed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/lockstep/lockstep_wire.h"
#include "bus/recovery/journal_file.h"

namespace halocline::conductor {

enum class EntryKind : std::uint8_t { kRun, kJoin, kRound, kLeave, kInjected, kEnd, kOver };

struct JournalEntry {
  EntryKind kind = EntryKind::kRun;
  bus::Bytes bytes;
};

// Returns all complete entries of the file, oldest first; empty if there is no file. Bytes after the last
// complete entry are cut off the file and counted. Throws InvalidArgument for a file with damage before that
// entry, because the entries after the damage would not continue the run, for a file of another kind, and for
// one that another process uses.
struct JournalContents {
  std::vector<JournalEntry> entries;
  std::size_t bytes_cut_off = 0;
};
JournalContents read_journal(const std::string& path);

class Journal {
 public:
  // Appends to the file, or creates it. Throws InvalidArgument when it cannot be written, is of another kind,
  // or is used by another process.
  explicit Journal(const std::string& path);

  // Returns false when the disk refuses the entry, or others deleted or truncated the file.
  [[nodiscard]] bool append(const JournalEntry& entry);

 private:
  bus::JournalFile file_;
};

}  // namespace halocline::conductor
