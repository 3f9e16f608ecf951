#include "bus/lockstep/journal.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline::conductor {
namespace {

constexpr std::uint32_t kMagic = 0x484c4a31;  // "HLJ1"
constexpr std::size_t kHeadBytes = 13;        // magic number, kind, length, check sum

// FNV-1a, 32 bits.
std::uint32_t check_sum(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0x811c9dc5u;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x01000193u;
  return sum;
}

bus::Bytes contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

JournalContents read_journal(const std::string& path) {
  JournalContents contents;
  const bus::Bytes file = contents_of(path);
  std::size_t at = 0;
  while (file.size() - at >= kHeadBytes && bus::uint32_at(file, at) == kMagic) {
    const std::size_t length = bus::uint32_at(file, at + 5);
    if (file.size() - at - kHeadBytes < length) break;
    const auto bytes = std::span(file).subspan(at + kHeadBytes, length);
    const bool known = file[at + 4] <= static_cast<std::uint8_t>(EntryKind::kOver);
    if (!known || bus::uint32_at(file, at + 9) != check_sum(bytes)) break;
    contents.entries.push_back({static_cast<EntryKind>(file[at + 4]), {bytes.begin(), bytes.end()}});
    at += kHeadBytes + length;
  }
  contents.bytes_cut_off = file.size() - at;
  if (contents.bytes_cut_off == 0) return contents;
  std::error_code error;
  std::filesystem::resize_file(path, at, error);
  if (error) throw std::runtime_error("cannot mend the journal " + path + ": " + error.message());
  return contents;
}

Journal::Journal(const std::string& path)
    : path_(path), file_(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {
  require(file_ >= 0, "cannot write the journal " + path + ": " + std::strerror(errno));
}

Journal::~Journal() { close(file_); }

void Journal::append(const JournalEntry& entry) {
  bus::Bytes bytes;
  bytes.reserve(kHeadBytes + entry.bytes.size());
  bus::append_uint32(kMagic, bytes);
  bytes.push_back(static_cast<std::uint8_t>(entry.kind));
  bus::append_uint32(static_cast<std::uint32_t>(entry.bytes.size()), bytes);
  bus::append_uint32(check_sum(entry.bytes), bytes);
  bytes.insert(bytes.end(), entry.bytes.begin(), entry.bytes.end());
  if (write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the journal " + path_ + " could not be written whole (disk full?)");
}

}  // namespace halocline::conductor
