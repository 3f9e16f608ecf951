// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bus/logs/log_series.h"
#include "core/check.h"
#include "core/files/input_file.h"

namespace halocline::clients {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxStretchesReported = 20;

struct Mapping {
  std::shared_ptr<const std::uint8_t> start;
  LogBytes bytes;
};

// Maps a file. An empty file cannot be mapped and gives an empty mapping.
Mapping map_file(const std::string& path) {
  const std::string why = why_unreadable(path);
  require(why.empty(), "cannot read the log " + path + ": " + why);
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  const bool is_open = file >= 0 && fstat(file, &status) == 0;
  const auto size = is_open ? static_cast<std::size_t>(status.st_size) : 0;
  void* start = size > 0 ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
  const std::string reason = std::strerror(errno);
  if (file >= 0) close(file);
  require(is_open && start != MAP_FAILED, "cannot read the log " + path + ": " + reason);
  if (size == 0) return {};
  madvise(start, size, MADV_SEQUENTIAL);
  const auto* bytes = static_cast<const std::uint8_t*>(start);
  return {{bytes, [start, size](const std::uint8_t*) { munmap(start, size); }}, {bytes, size}};
}

std::vector<std::string> all_files(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    for (std::string& file : series_of(path)) {
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(std::move(file));
    }
  }
  return files;
}

}  // namespace

std::vector<std::string> series_of(const std::string& path) {
  std::vector<std::string> files = bus::parts_of_log(path);
  if (fs::exists(path) || files.empty()) files.insert(files.begin(), path);
  return files;
}

LogReader::LogReader(const std::vector<std::string>& paths) : files_(all_files(paths)) {
  bool holds_an_event = false;
  std::string why;
  for (const std::string& path : files_) {
    const Mapping file = map_file(path);
    holds_an_event = holds_an_event || !next_event(file.bytes, 0).at_end;
    if (!looks_like_a_log(file.bytes))
      throw InvalidArgument(path + " is no LCM log: " + why_no_log(file.bytes));
    if (!holds_an_event && !file.bytes.empty()) why = ": " + why_no_log(file.bytes);
  }
  require(holds_an_event, files_.front() + " holds no event" + why);
}

bool LogReader::open_next_file() {
  if (next_file_ == files_.size()) return false;
  const Mapping mapping = map_file(files_[next_file_++]);
  mapping_ = mapping.start;
  log_ = mapping.bytes;
  bytes_ += static_cast<std::int64_t>(log_.size());
  at_ = 0;
  return true;
}

bool LogReader::next(LoggedEvent& event) {
  for (;;) {
    const LogStep step = next_event(log_, at_);
    note(step.damage);
    if (!step.at_end) {
      at_ = step.event.offset + step.event.size;
      event.number = step.event.number;
      event.stamp_us = step.event.stamp_us;
      event.channel = step.event.channel;
      event.data.assign(step.event.data.begin(), step.event.data.end());
      event.file = next_file_ - 1;
      event.offset = static_cast<std::int64_t>(step.event.offset);
      flows_.count(event.channel, event.data);
      contents_.count({event.stamp_us, event.channel, event.data, event.file, event.offset});
      return true;
    }
    at_ = log_.size();
    if (!open_next_file()) return false;
  }
}

void LogReader::note(const Damage& damage) {
  if (damage.size == 0) return;
  const auto bytes = static_cast<std::int64_t>(damage.size);
  truncated_ = truncated_ || damage.cut_short;
  if (!damage.cut_short) bytes_skipped_ += bytes;
  if (bad_.size() < kMaxStretchesKept)
    bad_.push_back({next_file_ - 1, static_cast<std::int64_t>(damage.offset), bytes, damage.cut_short});
}

std::string place_of(const LogReader& log, const LoggedEvent& event) {
  return log.files().at(event.file) + ", byte " + std::to_string(event.offset);
}

bool report_damage(std::ostream& out, const LogReader& log) {
  const auto& all = log.bad_stretches();
  for (std::size_t i = 0; i < std::min(all.size(), kMaxStretchesReported); ++i) {
    const BadStretch& bad = all[i];
    out << "halocline: " << log.files().at(bad.file) << ", byte " << bad.offset << ": ";
    if (bad.cut_short)
      out << "ends within an event, of which " << bad.bytes << " bytes are there; all before it was read\n";
    else
      out << bad.bytes << " bytes are no sound event and were skipped\n";
  }
  if (all.size() > kMaxStretchesReported)
    out << "halocline: and " << all.size() - kMaxStretchesReported << " more such stretches; "
        << log.bytes_skipped() << " bytes in all were skipped\n";
  const auto problems = log.contents().problems(log.files());
  for (const std::string& problem : problems) out << "halocline: " << problem << "\n";
  report_flows(out, log.flows());
  return all.empty() && problems.empty() && log.flows().missing() == 0;
}

}  // namespace halocline::clients
