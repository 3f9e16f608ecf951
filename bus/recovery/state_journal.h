// SPDX-License-Identifier: BSD-3-Clause
// State journal: the latest state of a node on disk, from which a restarted node continues.
//
// There are two files, `path`.0 and `path`.1. A file holds a header (bus/recovery/journal_file.h) and
// records, each with a number and a check sum: first a complete state, then the changes since the previous
// record. When a file has grown to four times its complete record, the other file is rewritten. A kill in the
// middle of a write leaves all previous records intact: either those of the same file, or the complete other
// file. A record is handed to the kernel before write() returns, so a killed process loses nothing that it
// acted upon; a machine that loses power may (nothing is forced to the disk).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::bus {

class StateJournal {
 public:
  using Bytes = std::vector<std::uint8_t>;
  struct Saved {
    std::int64_t session = 0;  // session of the node
    SimTime at;                // simulation time
    Bytes state;
    std::vector<Bytes> parts;  // parts of the state, for Archive
    Bytes additions;           // additions of all records since the complete one, concatenated
  };

  // `digest` is that of everything on which the meaning of the state depends; a state saved with another
  // digest is not inherited. Throws InvalidArgument when the files cannot be written, are not state journals,
  // or are used by another process.
  StateJournal(std::string path, std::uint64_t digest);
  ~StateJournal();
  StateJournal(const StateJournal&) = delete;
  StateJournal& operator=(const StateJournal&) = delete;

  // True when an earlier incarnation left files without a usable record.
  bool is_damaged() const { return is_damaged_; }
  // Last record of an earlier incarnation.
  const std::optional<Saved>& inherited() const { return inherited_; }

  // True when the next record has to hold all parts of the state, and all additions that are to be kept.
  bool wants_whole() const { return end_ == 0 || end_ >= max_bytes_; }
  // Saves `state` with its parts separate (Archive::begin_with_parts). Returns false when the disk refuses
  // the record, or another process deleted or truncated a file. Nothing can be inherited then until the next
  // record, a complete one, is written; the files are created again.
  [[nodiscard]] bool write(std::int64_t session, SimTime at, const Archive& state,
                           std::span<const std::uint8_t> additions);

 private:
  void open(std::size_t i);
  void forget();

  std::string path_;
  std::uint64_t digest_, number_ = 0;
  std::array<int, 2> files_ = {-1, -1};
  std::size_t current_ = 1;  // index of the current file
  // Sizes of the current file; end_ is 0 if it has no complete record of this incarnation.
  std::uint64_t end_ = 0, max_bytes_ = 0;
  bool is_damaged_ = false;
  std::optional<Saved> inherited_;
};

}  // namespace halocline::bus
