// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/journal_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/check.h"
#include "core/hash.h"

namespace halocline::bus {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::uint32_t kWord = 0x484c5231;  // "HLR1"
constexpr std::size_t kSumAt = 9;            // offset, after word, kind and length

void put(std::uint64_t value, int bytes, std::vector<std::uint8_t>& to) {
  for (int shift = 8 * bytes - 8; shift >= 0; shift -= 8)
    to.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint64_t get(View bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

std::uint64_t check_sum(View head, View body) { return xxh3(body, xxh3(head.first(kSumAt))); }

// Returns the record at the beginning of `bytes`; nothing if there is no complete one.
std::optional<View> whole_record(View bytes) {
  constexpr std::size_t kHead = JournalFile::kHeadBytes;
  if (bytes.size() < kHead || get(bytes, 0, 4) != kWord) return std::nullopt;
  const std::size_t length = get(bytes, 5, 4);
  if (bytes.size() - kHead < length) return std::nullopt;
  if (check_sum(bytes, bytes.subspan(kHead, length)) != get(bytes, kSumAt, 8)) return std::nullopt;
  return bytes.first(kHead + length);
}

// Takes the complete records at the beginning of `bytes`, one after the other. Returns their size in bytes.
std::size_t take_whole(View bytes, std::vector<JournalFile::Record>& records) {
  std::size_t at = 0;
  while (const auto record = whole_record(bytes.subspan(at))) {
    records.push_back({(*record)[4], {record->begin() + JournalFile::kHeadBytes, record->end()}});
    at += record->size();
  }
  return at;
}

// Returns the position of the next complete record in `bytes`; their end if there is none.
std::size_t next_whole(View bytes) {
  std::size_t at = 0;
  while (at < bytes.size() && !whole_record(bytes.subspan(at))) ++at;
  return at;
}

bool lock(int file) {
  struct flock all {};
  all.l_type = F_WRLCK;
  all.l_whence = SEEK_SET;
  return fcntl(file, F_SETLK, &all) == 0;
}

// True if the file is as its only writer left it: neither deleted nor truncated by others.
bool is_untouched(int file, std::size_t size) {
  struct stat status {};
  return fstat(file, &status) == 0 && status.st_nlink > 0 && static_cast<std::size_t>(status.st_size) >= size;
}

// Returns an empty string if the file can be used, otherwise the problem.
std::string problem_with(int file, std::string_view header) {
  if (file < 0) return std::strerror(errno);
  struct stat status {};
  if (fstat(file, &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "it is a device, a pipe or a folder; allowed is a regular file";
  if (!lock(file)) return "another process has it open";
  std::array<std::uint8_t, kJournalHeaderBytes> found{};
  const ssize_t size = pread(file, found.data(), found.size(), 0);
  if (size < 0) return std::strerror(errno);
  if (!std::equal(found.begin(), found.begin() + size, header.begin()))
    return "it is another file, or a journal of another version; it stays as it is";
  const View bytes(reinterpret_cast<const std::uint8_t*>(header.data()), header.size());
  if (static_cast<std::size_t>(size) < header.size() && !write_whole(file, 0, std::array{bytes}))
    return std::strerror(errno);
  return "";
}

}  // namespace

int open_journal(const std::string& path, std::string_view header) {
  ensure(header.size() == kJournalHeaderBytes, "the header of a journal has 16 bytes");
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  const std::string problem = problem_with(file, header);
  if (!problem.empty() && file >= 0) close(file);
  require(problem.empty(), "cannot use the journal " + path + ": " + problem);
  return file;
}

std::vector<std::uint8_t> content_of(int file) {
  struct stat status {};
  std::vector<std::uint8_t> bytes(fstat(file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0);
  std::size_t at = 0;
  while (at < bytes.size()) {
    const ssize_t read = pread(file, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
    if (read <= 0) break;
    at += static_cast<std::size_t>(read);
  }
  bytes.resize(at);
  return bytes;
}

bool write_whole(int file, std::size_t at, std::span<const View> pieces) {
  if (!is_untouched(file, at)) return false;
  std::size_t to = at;
  for (View piece : pieces) {
    while (!piece.empty()) {
      const ssize_t written = pwrite(file, piece.data(), piece.size(), static_cast<off_t>(to));
      if (written <= 0) {
        [[maybe_unused]] const int cut = ftruncate(file, static_cast<off_t>(at));
        return false;
      }
      to += static_cast<std::size_t>(written);
      piece = piece.subspan(static_cast<std::size_t>(written));
    }
  }
  return true;
}

JournalFile::JournalFile(const std::string& path, std::string_view header)
    : file_(open_journal(path, header)), end_(std::max(content_of(file_).size(), kJournalHeaderBytes)) {}

JournalFile::~JournalFile() { close(file_); }

JournalFile::Contents JournalFile::read() {
  Contents contents;
  const std::vector<std::uint8_t> bytes = content_of(file_);
  const View all(bytes);
  std::size_t end = std::min(kJournalHeaderBytes, bytes.size());
  while (true) {
    end += take_whole(all.subspan(end), contents.records);
    const std::size_t damaged = next_whole(all.subspan(end));
    if (end + damaged == bytes.size()) break;
    contents.bytes_damaged += damaged;
    end += damaged;
  }
  contents.bytes_cut = bytes.size() - end;
  if (contents.bytes_cut > 0 && ftruncate(file_, static_cast<off_t>(end)) == 0) end_ = end;
  return contents;
}

bool JournalFile::append(std::span<const Record> records) {
  std::vector<std::uint8_t> bytes;
  for (const Record& record : records) {
    std::vector<std::uint8_t> head;
    put(kWord, 4, head);
    put(record.kind, 1, head);
    put(record.body.size(), 4, head);
    put(check_sum(head, record.body), 8, head);
    bytes.insert(bytes.end(), head.begin(), head.end());
    bytes.insert(bytes.end(), record.body.begin(), record.body.end());
  }
  if (!write_whole(file_, end_, std::array{View(bytes)})) return false;
  end_ += bytes.size();
  return true;
}

}  // namespace halocline::bus
