// SPDX-License-Identifier: BSD-3-Clause
// The journals: of the conductor, of a node's messages, of a node's state. A kind, then the bytes behind the
// file's header, as they are; or records with check sums that hold, which the fuzzer need not find.
#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bus/lockstep/journal.h"
#include "bus/lockstep/journal_replay.h"
#include "bus/lockstep/sequencer.h"
#include "bus/messages/channels.h"
#include "bus/recovery/journal_file.h"
#include "bus/recovery/message_journal.h"
#include "bus/recovery/state_journal.h"
#include "core/archive.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

namespace {

using namespace halocline;

fuzz::ScratchFile& scratch() {
  static fuzz::ScratchFile file("");
  return file;
}

const std::string& bytes_behind(std::string_view header, fuzz::Input& input) {
  return scratch().write(std::string(header) + std::string(input.rest_as_text()));
}

const std::string& records_behind(std::string_view header, fuzz::Input& input) {
  const std::string& path = scratch().write("");
  bus::JournalFile file(path, header);
  std::vector<bus::JournalFile::Record> records;
  while (!input.is_empty()) {
    const std::uint8_t kind = input.number();
    const auto body = input.block();
    records.push_back({kind, {body.begin(), body.end()}});
  }
  ensure(file.append(records), "memory takes the records");
  return path;
}

void take_conductors(const std::string& path) {
  const conductor::JournalContents contents = conductor::read_journal(path);
  conductor::Sequencer sequencer([](const lockstep_message_t&) {});
  conductor::replay_journal(contents.entries, "digest", sequencer);
}

void take_messages(const std::string& path) {
  bus::MessageJournal journal({path, SimDuration::from_seconds(10), {bus::channels::kState}, {"OUTCOME"}});
  for (const auto& entry : journal.take_inherited())
    journal.add_input(entry.channel, entry.bytes.data(), entry.bytes.size());
  journal.write_inputs(SimTime::from_seconds(20));
}

void take_state(const std::string& path) {
  std::filesystem::rename(path, path + ".0");
  bus::StateJournal journal(path, 1);
  if (!journal.inherited()) return;
  Archive archive(journal.inherited()->state, journal.inherited()->parts);
  std::vector<std::string> texts;
  std::map<std::int32_t, vehicle_state_t> states;
  archive(texts, states);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  try {
    switch (input.below(5)) {
      case 0:
        take_conductors(bytes_behind("HALOCLINE ROUND2", input));
        break;
      case 1:
        take_conductors(records_behind("HALOCLINE ROUND2", input));
        break;
      case 2:
        take_messages(bytes_behind("HALOCLINE INPUT2", input));
        break;
      case 3:
        take_messages(records_behind("HALOCLINE INPUT2", input));
        break;
      default:
        take_state(bytes_behind("HALOCLINE STATE2", input));
    }
  } catch (const std::runtime_error&) {  // of another scenario, of no conductor, of no instant's end
  } catch (const InvalidArgument&) {
  }
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(scratch().path()).parent_path()))
    std::filesystem::remove(entry.path());
  return 0;
}
