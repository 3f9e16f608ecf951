// SPDX-License-Identifier: BSD-3-Clause
#include "bus/recovery/state_journal.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

#include <unistd.h>

#include "bus/recovery/journal_file.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::bus {
namespace {

using Bytes = StateJournal::Bytes;
using View = std::span<const std::uint8_t>;

constexpr std::string_view kStateHeader = "HALOCLINE STATE2";
constexpr std::uint64_t kGrowth = 4, kMinFileBytes = 64 << 10;
constexpr std::uint64_t kMaxParts = 1 << 20;

// A record holds a head, the state without its parts, the list of parts, the bytes of the parts, and the
// additions.
struct Head {
  std::uint64_t check_sum = 0;  // covers all bytes after it
  std::uint64_t digest = 0, number = 0;
  std::int64_t session = 0;
  SimTime at;
  std::uint64_t is_whole = 0;
  std::array<std::uint64_t, 4> sizes = {};  // sizes of the pieces after the head, bytes

  std::uint64_t size_of_body() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t size : sizes) sum += size;
    return sum;
  }
};
static_assert(std::has_unique_object_representations_v<Head>);

template <class T>
View bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

// XXH3; each piece is hashed with the hash of the previous pieces as its seed.
std::uint64_t check_sum(const Head& head, std::span<const View> body) {
  std::uint64_t sum = xxh3(bytes_of(std::span(&head, 1)).subspan(sizeof head.check_sum));
  for (const View piece : body) sum = xxh3(piece, sum);
  return sum;
}

struct Record {
  Head head;
  std::array<View, 4> body;
};

// Returns the record at the beginning of `file`; nothing if there is no complete one.
std::optional<Record> read_record(View file) {
  Record record;
  if (file.size() < sizeof record.head) return std::nullopt;
  std::memcpy(&record.head, file.data(), sizeof record.head);
  file = file.subspan(sizeof record.head);
  for (std::size_t i = 0; i < record.body.size(); ++i) {
    if (record.head.sizes[i] > file.size()) return std::nullopt;
    record.body[i] = file.first(record.head.sizes[i]);
    file = file.subspan(record.head.sizes[i]);
  }
  if (check_sum(record.head, record.body) != record.head.check_sum) return std::nullopt;
  return record;
}

void take(const Record& record, StateJournal::Saved& saved) {
  const auto [state, list, parts, additions] = record.body;
  saved.session = record.head.session;
  saved.at = record.head.at;
  saved.state.assign(state.begin(), state.end());
  if (record.head.is_whole != 0) {
    saved.parts.clear();
    saved.additions.clear();
  }
  saved.additions.insert(saved.additions.end(), additions.begin(), additions.end());
  std::size_t at = 0;
  for (std::size_t i = 0; i + sizeof(Archive::Part) <= list.size(); i += sizeof(Archive::Part)) {
    Archive::Part part;
    std::memcpy(&part, list.data() + i, sizeof part);
    if (part.index >= kMaxParts || part.size > parts.size() - at) return;
    if (part.index >= saved.parts.size()) saved.parts.resize(part.index + 1);
    const View bytes = parts.subspan(at, part.size);
    saved.parts[part.index].assign(bytes.begin(), bytes.end());
    at += part.size;
  }
}

struct Found {
  std::uint64_t number = 0;  // number of the last record
  StateJournal::Saved saved;
};

// Combines the records of a file. They may be followed by older ones, left over from the previous use of the
// file.
std::optional<Found> read(View file, std::uint64_t digest) {
  file = file.subspan(std::min(file.size(), kJournalHeaderBytes));
  std::optional<Found> found;
  while (const auto record = read_record(file)) {
    const Head& head = record->head;
    const bool follows = found ? head.is_whole == 0 && head.number == found->number + 1 : head.is_whole != 0;
    if (head.digest != digest || !follows) break;
    if (!found) found.emplace();
    found->number = head.number;
    take(*record, found->saved);
    file = file.subspan(sizeof head + head.size_of_body());
  }
  return found;
}

}  // namespace

StateJournal::StateJournal(std::string path, std::uint64_t digest) : path_(std::move(path)), digest_(digest) {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    open(i);
    const Bytes bytes = content_of(files_[i]);
    auto found = read(bytes, digest);
    is_damaged_ = is_damaged_ || (!found && bytes.size() > kJournalHeaderBytes);
    if (!found || found->number < number_) continue;
    number_ = found->number + 1;
    current_ = i;
    inherited_ = std::move(found->saved);
  }
  is_damaged_ = is_damaged_ && !inherited_;
}

StateJournal::~StateJournal() {
  for (const int file : files_) {
    if (file >= 0) close(file);
  }
}

void StateJournal::open(std::size_t i) {
  files_[i] = open_journal(path_ + "." + std::to_string(i), kStateHeader);
}

bool StateJournal::write(std::int64_t session, SimTime at, const Archive& state,
                         std::span<const std::uint8_t> additions) {
  const bool is_whole = wants_whole();
  if (is_whole) {
    current_ = 1 - current_;
    end_ = kJournalHeaderBytes;
    try {
      if (files_[current_] < 0) open(current_);
    } catch (const InvalidArgument&) {
      end_ = 0;
      return false;
    }
  }
  const std::array<View, 4> body = {state.bytes(), bytes_of(std::span(state.parts())), state.bytes_of_parts(),
                                    additions};
  Head head{0, digest_, number_, session, at, is_whole, {}};
  std::array<View, 5> pieces{bytes_of(std::span<const Head>(&head, 1))};
  for (std::size_t i = 0; i < body.size(); ++i) {
    head.sizes[i] = body[i].size();
    pieces[i + 1] = body[i];
  }
  head.check_sum = check_sum(head, body);
  const std::uint64_t size = sizeof head + head.size_of_body();
  if (!write_whole(files_[current_], end_, pieces)) {
    forget();
    return false;
  }
  if (is_whole) max_bytes_ = std::max(kGrowth * size, kMinFileBytes);
  end_ += size;
  ++number_;
  return true;
}

// Results of the state that could not be written are published, so no earlier state may be resumed. The files
// are opened again, as another process may have deleted them.
void StateJournal::forget() {
  for (int& file : files_) {
    if (file < 0) continue;
    [[maybe_unused]] const int cut = ftruncate(file, 0);
    close(std::exchange(file, -1));
  }
  end_ = 0;
}

}  // namespace halocline::bus
