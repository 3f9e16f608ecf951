// SPDX-License-Identifier: BSD-3-Clause
// Journal file: a file of records that a killed process leaves to its next incarnation.
//
// A header of 16 bytes names the kind of journal. Each record consists of a sync word, kind, length, a check
// sum (XXH3) over these and the body, and the body. Appended records are handed to the kernel before append()
// returns, all of them or none; nothing is forced to the disk. A record that a kill cut off at the end is
// ignored. A record whose check sum does not fit is left out, and the records after it are found by their
// sync word.
//
// A file that is neither empty nor of this kind is left unchanged, and so is one that another process has
// open (POSIX record lock).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::bus {

inline constexpr std::size_t kJournalHeaderBytes = 16;

// Opens or creates a file for reading and writing, locks it, and writes `header` (16 bytes) into a new one.
// The caller closes the descriptor. Throws InvalidArgument when this fails, when another process has the
// file, when it is not a regular file, and when it has another header.
int open_journal(const std::string& path, std::string_view header);
std::vector<std::uint8_t> content_of(int file);
// Writes all pieces at `at`, or nothing. Returns false when the disk refuses them (the file then ends at
// `at`), and when the file was deleted, or truncated to less than `at`.
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
    std::size_t bytes_damaged = 0;  // between complete records
    std::size_t bytes_cut = 0;      // after the last complete record
  };
  static constexpr std::size_t kHeadBytes = 17;  // size of a record's head

  // Opens the file as open_journal() does.
  JournalFile(const std::string& path, std::string_view header);
  ~JournalFile();
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // Returns all complete records, oldest first. Bytes after the last one are cut off the file.
  Contents read();
  // Returns false, and appends nothing, if write_whole() fails.
  [[nodiscard]] bool append(std::span<const Record> records);

 private:
  int file_;
  std::size_t end_;
};

}  // namespace halocline::bus
