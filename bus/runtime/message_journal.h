// SPDX-License-Identifier: BSD-3-Clause
// Write-ahead journal of a node's recent steps, their inputs and outputs: a file from which the next
// incarnation of a node that was killed restores what was under way (crash_journal.h). A node whose state can
// be written whole keeps that instead (state_journal.h).
//
// A file of records (bus/files/journal_file.h). What is written is handed to the kernel before anything that
// follows from it is published, so a killed process loses nothing that anybody acted upon; a machine that
// loses power may (nothing is forced to the disk). What a kill cut off at the end is no entry, nor is one of
// which a bit changed. When the disk refuses an entry, or others deleted or truncated the file, the journal
// is given up and removed, and the node goes on without one.
//
// Bounded: once a file spans `kept` of simulation time, it becomes `path`.1 (in the place of the one before)
// and another begins with what is carried over: the last input of each flow of `keep_last` (of the latest
// eight sessions of a channel, and of four channels for each of kMaxVehicles), and the inputs on `keep_all`
// (the latest 1000). So at least `kept` is there, and twice that at most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/channels.h"
#include "bus/files/journal_file.h"
#include "core/sim_time.h"

namespace halocline::bus {

struct JournalledMessage {
  enum class Kind : std::uint8_t {
    kInput,
    kOutput,
    kStep,    // that took no input
    kDigest,  // first in a file: what the run is, as `at`
  };
  Kind kind = Kind::kInput;
  SimTime at;  // simulation time of the step that took it, or made it
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

class MessageJournal {
 public:
  struct Rule {
    std::string path;
    SimDuration kept;  // above 0
    std::vector<Family> keep_last;
    std::vector<std::string> keep_all;  // channels
    // Of all that the steps depend on: what was written with another one is not inherited.
    std::uint64_t digest = 0;
  };
  // Reads what an earlier incarnation left at `rule.path`. Throws InvalidArgument when it cannot be written,
  // is another file, or another process has it.
  explicit MessageJournal(Rule rule);
  MessageJournal(const MessageJournal&) = delete;
  MessageJournal& operator=(const MessageJournal&) = delete;

  // What the earlier incarnation left, by time; moved out, once.
  std::vector<JournalledMessage> take_inherited() { return std::move(inherited_); }

  // Whether a journal was there that is not inherited.
  bool is_of_another_run() const { return is_of_another_run_; }
  // Whether the last input of each flow of the channel is kept.
  bool keeps_last(std::string_view channel) const;
  // Bytes of the earlier incarnation's files that were no whole entry; flipped bits that were set right
  // (journal_file.h).
  std::size_t bytes_damaged() const { return bytes_damaged_; }
  std::size_t bits_mended() const { return bits_mended_; }
  // The disk refused an entry; nothing more is written.
  bool is_given_up() const { return file_ == nullptr; }

  // Keeps a received message in memory until the step that takes it.
  void add_input(std::string_view channel, const void* data, std::size_t size);
  // Writes the inputs added since, as taken at `now`; before them the latest step without any, if it came
  // after what was written last: what it did, it did before it knew them.
  void write_inputs(SimTime now);
  void write_output(SimTime now, std::string_view channel, std::vector<std::uint8_t> bytes);
  // Another run: forgets everything but the inputs added since the last step.
  void clear();

 private:
  void read(JournalFile& file);
  void give_up();
  void begin_file(const std::vector<JournalledMessage>& entries);
  void write(const std::vector<JournalledMessage>& entries);
  void carry(const JournalledMessage& entry);
  void forget_older_half();
  std::vector<JournalledMessage> carried() const;

  Rule rule_;
  std::unique_ptr<JournalFile> file_;
  std::size_t bytes_damaged_ = 0, bits_mended_ = 0;
  bool is_of_another_run_ = false;
  SimTime file_begins_ = SimTime::never();
  std::optional<SimTime> idle_step_;
  std::vector<JournalledMessage> inherited_, inputs_;
  std::map<std::string, std::vector<JournalledMessage>>
      kept_last_;  // by channel: of each session, the latest last
  std::deque<JournalledMessage> kept_all_;
};

}  // namespace halocline::bus
