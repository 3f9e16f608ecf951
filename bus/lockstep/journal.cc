// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/journal.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "core/check.h"

namespace halocline::conductor {
namespace {

constexpr std::string_view kHeader = "HALOCLINE ROUND2";

}  // namespace

JournalContents read_journal(const std::string& path) {
  JournalContents contents;
  if (!std::filesystem::exists(path)) return contents;
  bus::JournalFile file(path, kHeader);
  bus::JournalFile::Contents read = file.read();
  require(read.bytes_damaged == 0,
          "the journal " + path + " is damaged: " + std::to_string(read.bytes_damaged) +
              " bytes before its last entry are none, and the run cannot be continued from it");
  contents.bytes_cut_off = read.bytes_cut;
  for (bus::JournalFile::Record& record : read.records)
    contents.entries.push_back({static_cast<EntryKind>(record.kind), std::move(record.body)});
  return contents;
}

Journal::Journal(const std::string& path) : file_(path, kHeader) {}

bool Journal::append(const JournalEntry& entry) {
  return file_.append(
      std::array{bus::JournalFile::Record{static_cast<std::uint8_t>(entry.kind), entry.bytes}});
}

}  // namespace halocline::conductor
