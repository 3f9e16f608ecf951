#include "clients/halocline/log_reader.h"

#include <filesystem>
#include <ostream>

#include "core/check.h"

namespace halocline::clients {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kSyncBytes = 4, kHeaderBytes = 24;
// LCM's own limits: a channel name is shorter than 64 bytes; a message cannot exceed what udpm fragments.
constexpr std::uint32_t kLongestChannel = 63, kLongestData = 1u << 28;

std::uint64_t big_endian(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace

LogReader::LogReader(const std::string& path) : file_(std::fopen(path.c_str(), "rb")) {
  require(file_ != nullptr && !std::filesystem::is_directory(path), "cannot read the log " + path);
  size_ = static_cast<long>(std::filesystem::file_size(path));
}

bool LogReader::next(LoggedEvent& event) {
  while (find_sync()) {
    const long body = std::ftell(file_.get());
    if (read_body(event)) return true;
    resume_after(body);
  }
  return false;
}

// Moves behind the next sync word.
bool LogReader::find_sync() {
  std::uint32_t window = 0;
  std::int64_t read = 0;
  for (int c = std::fgetc(file_.get()); c != EOF; c = std::fgetc(file_.get())) {
    window = window << 8 | static_cast<std::uint32_t>(c);
    ++read;
    if (read >= static_cast<std::int64_t>(kSyncBytes) && window == kSync) {
      bytes_skipped_ += read - static_cast<std::int64_t>(kSyncBytes);
      return true;
    }
  }
  bytes_skipped_ += read;
  return false;
}

bool LogReader::read_body(LoggedEvent& event) {
  std::uint8_t header[kHeaderBytes];
  if (!read_bytes(header, sizeof header)) return false;
  event.number = static_cast<std::int64_t>(big_endian(header, 8));
  event.stamp_us = static_cast<std::int64_t>(big_endian(header + 8, 8));
  const auto channel_size = static_cast<std::uint32_t>(big_endian(header + 16, 4));
  const auto data_size = static_cast<std::uint32_t>(big_endian(header + 20, 4));
  if (channel_size == 0 || channel_size > kLongestChannel || data_size > kLongestData) return false;
  event.channel.resize(channel_size);
  if (!read_bytes(event.channel.data(), channel_size)) return false;
  // A corrupt length must not allocate more than the file holds.
  truncated_ = std::ftell(file_.get()) + static_cast<long>(data_size) > size_;
  if (truncated_) return false;
  event.data.resize(data_size);
  return read_bytes(event.data.data(), data_size);
}

bool LogReader::read_bytes(void* into, std::size_t size) {
  truncated_ = std::fread(into, 1, size, file_.get()) != size;
  return !truncated_;
}

void LogReader::resume_after(long place) {
  bytes_skipped_ += static_cast<std::int64_t>(kSyncBytes);
  std::clearerr(file_.get());
  std::fseek(file_.get(), place, SEEK_SET);
}

void tell_damage(std::ostream& out, const LogReader& log) {
  if (log.truncated()) out << "halocline: the log ends within an event; all before it was read\n";
  if (log.bytes_skipped() > 0) {
    out << "halocline: " << log.bytes_skipped() << " bytes of the log are no sound event and were skipped\n";
  }
}

}  // namespace halocline::clients
