// SPDX-License-Identifier: BSD-3-Clause
// Write-ahead journal of the conductor: the inputs of its sequencer in their order, from which a new
// incarnation continues the run.
//
// A file of records (bus/files/journal_file.h) of LCM-encoded messages. Each entry is handed to the kernel
// before anything that follows from it is sent, so a killed process loses nothing that anybody acted upon; a
// machine that loses power may (no fsync). An entry that a kill cut short is removed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/files/journal_file.h"
#include "bus/lockstep/lockstep_wire.h"

namespace halocline::conductor {

enum class EntryKind : std::uint8_t { kRun, kJoin, kRound, kLeave, kInjected, kEnd, kOver };

struct JournalEntry {
  EntryKind kind = EntryKind::kRun;
  bus::Bytes bytes;
};

// All whole entries of the file, oldest first; empty when there is no file. The bytes behind the last whole
// one are cut off the file, and one flipped bit of an entry is set right; both are counted. Throws
// InvalidArgument for a file that is damaged otherwise, because what follows would not follow from it, is
// none of ours, or that another process has.
struct JournalContents {
  std::vector<JournalEntry> entries;
  std::size_t bytes_cut_off = 0, bits_mended = 0;
};
JournalContents read_journal(const std::string& path);

class Journal {
 public:
  // Appends to the file, or creates it. Throws InvalidArgument when it cannot be written, is none of ours, or
  // another process has it.
  explicit Journal(const std::string& path);

  // False when the disk refuses it, or others deleted or truncated the file.
  [[nodiscard]] bool append(const JournalEntry& entry);

 private:
  bus::JournalFile file_;
};

}  // namespace halocline::conductor
