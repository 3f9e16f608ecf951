// The conductor's memory on disk: everything its sequencer was told, in order, so that a conductor that was killed
// goes on where it was.
//
// A file of entries: a word that begins each, its kind, the length of its bytes, a check sum, the bytes (LCM-encoded
// messages). Each entry is handed to the kernel in one write before anything that follows from it is said, so a
// killed process loses nothing that anybody acted upon; a machine that loses power may (nothing is forced to the
// disk). What a kill cut off at the end is no entry, and is removed.
#pragma once

#include <string>
#include <vector>

#include "bus/lockstep/lockstep_wire.h"

namespace halocline::conductor {

enum class EntryKind : std::uint8_t { kRun, kJoin, kRound, kFarewell, kOutside, kEnd, kOver };

struct JournalEntry {
  EntryKind kind = EntryKind::kRun;
  bus::Bytes bytes;
};

// All whole entries of the file, oldest first; empty when there is no file. What follows the last whole one is cut
// off the file, and told. Throws std::runtime_error when the file cannot be read or cut.
struct JournalContents {
  std::vector<JournalEntry> entries;
  std::size_t bytes_cut_off = 0;
};
JournalContents read_journal(const std::string& path);

class Journal {
 public:
  // Goes on at the end of the file, or begins one. Throws InvalidArgument when it cannot be written.
  explicit Journal(const std::string& path);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Throws std::runtime_error when the disk refuses it.
  void append(const JournalEntry& entry);

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace halocline::conductor
