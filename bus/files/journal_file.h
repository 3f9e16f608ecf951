// SPDX-License-Identifier: BSD-3-Clause
// A file of records that a killed process leaves to its next incarnation.
//
// A header of 16 bytes names the kind of journal; then records: a word that begins each, kind, length, a
// check sum (XXH3) over these and the body, body. Appended records are handed to the kernel before append()
// returns, all of them or none; nothing is forced to the disk. What a kill cut off at the end is no record.
// One flipped bit of a record is found by its check sum, and set right; a record that is damaged otherwise is
// left out, and those behind it are found by their word.
//
// A file that is neither empty nor of this kind is not touched, nor is one that another process has open
// (POSIX record lock).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::bus {

inline constexpr std::size_t kJournalHeaderBytes = 16;

// Opens or makes a file for reading and writing, locks it, and writes `header` (of 16 bytes) into a new one.
// The caller closes the descriptor. Throws InvalidArgument when that cannot be, when another process has it,
// for what is no ordinary file, and for a file with another header.
int open_journal(const std::string& path, std::string_view header);
// The bytes of an open file.
std::vector<std::uint8_t> content_of(int file);
// Writes all of them at `at`, or nothing: returns false when the disk refuses them (the file ends at `at`
// then), and when the file was deleted, or truncated to less than `at`.
[[nodiscard]] bool write_whole(int file, std::size_t at,
                               std::span<const std::span<const std::uint8_t>> pieces);

class JournalFile {
 public:
  struct Record {
    std::uint8_t kind = 0;
    std::vector<std::uint8_t> body;
  };
  struct Contents {
    std::vector<Record> records;
    std::size_t bits_mended = 0;    // flipped ones, set right in the file, too
    std::size_t bytes_damaged = 0;  // between whole records
    std::size_t bytes_cut = 0;      // behind the last whole one
  };
  static constexpr std::size_t kHeadBytes = 17;  // of a record

  // As open_journal().
  JournalFile(const std::string& path, std::string_view header);
  ~JournalFile();
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // All whole records, oldest first. What is behind the last one is cut off the file.
  Contents read();
  // False, and nothing is appended, where write_whole() refuses.
  [[nodiscard]] bool append(std::span<const Record> records);

 private:
  int file_;
  std::size_t end_;
};

}  // namespace halocline::bus
