// SPDX-License-Identifier: BSD-3-Clause
// Write-ahead journal of a node's recent steps with their inputs and outputs: the file from which a restarted
// node restores its work in progress (crash_journal.h). A node whose complete state can be saved keeps that
// instead (state_journal.h).
//
// The file consists of records (bus/recovery/journal_file.h). Entries are handed to the kernel before
// anything that depends on them is published, so a killed process loses nothing that another node has acted
// upon; a machine that loses power may (nothing is forced to the disk). An entry that a kill cut off at the
// end is ignored, and so is one whose bytes changed. When the disk refuses an entry, or another process
// deleted or truncated the file, the journal is abandoned and removed, and the node continues without one.
//
// The size is bounded. Once a file spans `kept` of simulation time, it is renamed to `path`.1 (replacing the
// previous one), and a new file begins with the entries that are carried over: the last input of each flow of
// `keep_last` (at most the latest eight sessions of a channel, and four channels for each of kMaxVehicles),
// and the inputs on `keep_all` (the latest 1000). The journal therefore covers at least `kept` and at most
// twice that.
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

#include "bus/messages/channels.h"
#include "bus/recovery/journal_file.h"
#include "core/sim_time.h"

namespace halocline::bus {

struct JournalledMessage {
  enum class Kind : std::uint8_t {
    kInput,
    kOutput,
    kStep,    // a step without inputs
    kDigest,  // first entry of a file: digest of the run, stored in `at`
  };
  Kind kind = Kind::kInput;
  SimTime at;  // simulation time of the step that took the input or made the output
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
    // Digest of everything that the steps depend on; entries written with another digest are not inherited.
    std::uint64_t digest = 0;
  };
  // Reads the entries that an earlier incarnation left at `rule.path`. Throws InvalidArgument when the file
  // cannot be written, is not a journal, or is used by another process.
  explicit MessageJournal(Rule rule);
  MessageJournal(const MessageJournal&) = delete;
  MessageJournal& operator=(const MessageJournal&) = delete;

  // Entries of the earlier incarnation, by time. Moved out; call once.
  std::vector<JournalledMessage> take_inherited() { return std::move(inherited_); }

  // True when a journal of another run was found; it is not inherited.
  bool is_of_another_run() const { return is_of_another_run_; }
  // True when the last input of each flow of the channel is kept.
  bool keeps_last(std::string_view channel) const;
  // Bytes in the earlier incarnation's files that were no complete entry.
  std::size_t bytes_damaged() const { return bytes_damaged_; }
  // True when the disk refused an entry; nothing more is written.
  bool is_given_up() const { return file_ == nullptr; }

  // Keeps a received message in memory until the step that takes it.
  void add_input(std::string_view channel, const void* data, std::size_t size);
  // Writes the inputs added since the last call, as taken at `now`. If the latest step had no inputs and came
  // after the last entry, it is written first, because it did not know these inputs.
  void write_inputs(SimTime now);
  void write_output(SimTime now, std::string_view channel, std::vector<std::uint8_t> bytes);
  // Another run has begun: discards everything except the inputs added since the last step.
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
  std::size_t bytes_damaged_ = 0;
  bool is_of_another_run_ = false;
  SimTime file_begins_ = SimTime::never();
  std::optional<SimTime> idle_step_;
  std::vector<JournalledMessage> inherited_, inputs_;
  // Last inputs by channel: one for each session, the latest at the end.
  std::map<std::string, std::vector<JournalledMessage>> kept_last_;
  std::deque<JournalledMessage> kept_all_;
};

}  // namespace halocline::bus
