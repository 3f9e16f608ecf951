// SPDX-License-Identifier: BSD-3-Clause
// The latest state of a node on disk, from which its next incarnation goes on when this one was killed.
//
// Two files, `path`.0 and `path`.1. A file holds a header (bus/files/journal_file.h) and records, each with a
// number and a check sum: first a whole one, then what has changed since the record before. When a file has
// grown to four times its whole record, the other one is begun anew. A kill in the middle of a write leaves
// all records before it: either those of the same file, or the other file whole. What is written is handed to
// the kernel before write() returns, so that a killed process loses nothing that it acted upon; a machine
// that loses power may (nothing is forced to the disk).
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
    std::int64_t session = 0;  // of the node
    SimTime at;                // simulation time
    Bytes state;
    std::vector<Bytes> parts;  // of the state, for Archive
    Bytes additions;           // of all records since the whole one, one after the other
  };

  // `digest` of all that the state's meaning depends on: what was saved with another one is not inherited.
  // Throws InvalidArgument when the files cannot be written, are others, or another process has them.
  StateJournal(std::string path, std::uint64_t digest);
  ~StateJournal();
  StateJournal(const StateJournal&) = delete;
  StateJournal& operator=(const StateJournal&) = delete;

  // An earlier incarnation left files without a record that can be taken up.
  bool is_damaged() const { return is_damaged_; }
  // What an earlier incarnation wrote last.
  const std::optional<Saved>& inherited() const { return inherited_; }

  // Whether the next record has to hold all parts of the state, and all additions that are to be kept.
  bool wants_whole() const { return end_ == 0 || end_ >= max_bytes_; }
  // `state` is saved with its parts apart (Archive::begin_with_parts). False when the disk refuses it, or
  // when others deleted or truncated a file: nothing is inherited then, until the next record, a whole one,
  // is written; the files are made anew.
  [[nodiscard]] bool write(std::int64_t session, SimTime at, const Archive& state,
                           std::span<const std::uint8_t> additions);

 private:
  void open(std::size_t i);
  void forget();

  std::string path_;
  std::uint64_t digest_, number_ = 0;
  std::array<int, 2> files_ = {-1, -1};
  std::size_t current_ = 1;  // of the files
  std::uint64_t end_ = 0,
                max_bytes_ = 0;  // of the current file; 0: it has no whole record of this incarnation
  bool is_damaged_ = false;
  std::optional<Saved> inherited_;
};

}  // namespace halocline::bus
