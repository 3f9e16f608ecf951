// Reads an LCM log event by event, whatever state it is in: what is sound is read, the rest is counted.
//
// Format (LCM's documentation of its event log): each event is, big-endian, the word 0xEDA1DA01, a 64-bit number, a
// 64-bit time stamp in microseconds, the 32-bit lengths of channel and data, then channel and data. A log that ends
// within an event (a recorder that was killed) yields all events before; after bytes that are no event the
// reader goes on at the next word that starts a sound one.
#pragma once

#include <cstdint>
#include <cstdio>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace halocline::clients {

struct LoggedEvent {
  std::int64_t number = 0;
  std::int64_t stamp_us = 0;  // simulation time in our own logs, the wall clock in lcm-logger's
  std::string channel;
  std::vector<std::uint8_t> data;
};

class LogReader {
 public:
  // Throws InvalidArgument when the file cannot be opened.
  explicit LogReader(const std::string& path);

  // False at the end of the log.
  bool next(LoggedEvent& event);

  std::int64_t bytes_skipped() const { return bytes_skipped_; }  // that belonged to no event
  bool truncated() const { return truncated_; }                  // the log ends within an event

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool read_body(LoggedEvent& event);
  bool find_sync();
  bool read_bytes(void* into, std::size_t size);
  void resume_after(long place);

  std::unique_ptr<std::FILE, Closer> file_;
  long size_ = 0;  // of the file, bytes
  std::int64_t bytes_skipped_ = 0;
  bool truncated_ = false;
};

// Writes a line about each kind of damage that was met so far; none when the log was sound.
void tell_damage(std::ostream& out, const LogReader& log);

}  // namespace halocline::clients
