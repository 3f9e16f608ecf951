// A node's memory on disk of what it heard and said lately, so that its next life knows what was under way
// when this one was killed.
//
// A file of entries: a word that begins each, its kind, stamp, lengths, a check sum, channel and message. What is
// written is handed to the kernel before anything that follows from it is said, so a killed process forgets nothing
// that anybody acted upon; a machine that loses power may (nothing is forced to the disk). What a kill cut off at
// the end is no entry.
//
// Bounded: once a file spans `kept` of simulation time, it becomes `path`.1 (in the place of the one before)
// and another begins, with what is carried along: the last message of each channel of `carries_last`, and all
// on `carries_all` (the latest 1000). So at least `kept` is there, and twice that at most.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bus/channels.h"
#include "core/sim_time.h"

namespace halocline::bus {

struct JournalledMessage {
  enum class Kind : std::uint8_t {
    kHeard,
    kSaid,               // by this node
    kHeardAfterAbsence,  // after this node's return, perhaps much later than it was said
  };
  Kind kind = Kind::kHeard;
  SimTime at;  // simulation time of the step that took it, or said it
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

class MessageJournal {
 public:
  struct Rule {
    std::string path;
    SimDuration kept;  // above 0
    std::vector<Family> carries_last;
    std::vector<std::string> carries_all;  // channels
  };
  // Takes up what an earlier life left at `rule.path`. Throws InvalidArgument when it cannot be written.
  explicit MessageJournal(Rule rule);
  ~MessageJournal();
  MessageJournal(const MessageJournal&) = delete;
  MessageJournal& operator=(const MessageJournal&) = delete;

  // What the earlier life left, by time; moved out, once.
  std::vector<JournalledMessage> take_inherited() { return std::move(inherited_); }

  // Keeps a message in memory until the step that takes it.
  void hear(std::string_view channel, const void* data, std::size_t size);
  // Writes what was heard since, as taken at `now`.
  void write_heard(SimTime now, JournalledMessage::Kind kind = JournalledMessage::Kind::kHeard);
  void write_said(SimTime now, std::string_view channel, std::vector<std::uint8_t> bytes);
  // Another run: forgets everything but what was heard since the last step.
  void clear();

 private:
  void begin_file(const std::vector<JournalledMessage>& entries);
  void write(const std::vector<JournalledMessage>& entries);
  void carry(const JournalledMessage& entry);
  std::vector<JournalledMessage> carried() const;

  Rule rule_;
  int file_ = -1;
  SimTime file_begins_ = SimTime::never();
  std::vector<JournalledMessage> inherited_, heard_;
  std::map<std::string, JournalledMessage> carried_last_;  // by channel
  std::deque<JournalledMessage> carried_all_;
};

}  // namespace halocline::bus
