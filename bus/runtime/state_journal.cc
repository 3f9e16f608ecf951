#include "bus/runtime/state_journal.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include "core/archive.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::bus {
namespace {

// A file holds a head, then the state.
struct Head {
  std::uint64_t check_sum = 0;  // FNV-1a of all that follows
  std::uint64_t digest = 0, number = 0;
  std::int64_t session = 0;
  SimTime at;
  std::uint64_t size = 0;  // of the state
};

std::uint64_t check_sum(Head head, std::span<const std::uint8_t> state) {
  Archive covered;
  covered(head.digest, head.number, head.session, head.at, head.size);
  return fnv1a(state, fnv1a(covered.bytes()));
}

// The number and the state; empty where a file holds no whole one.
std::optional<std::pair<std::uint64_t, StateJournal::Saved>> read(const std::string& path,
                                                                  std::uint64_t digest) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (file.size() < sizeof(Head)) return std::nullopt;
  Head head;
  std::memcpy(&head, file.data(), sizeof head);
  if (head.digest != digest || head.size > file.size() - sizeof head) return std::nullopt;
  const auto state = std::span(file).subspan(sizeof head, head.size);
  if (check_sum(head, state) != head.check_sum) return std::nullopt;
  return std::pair(head.number, StateJournal::Saved{head.session, head.at, {state.begin(), state.end()}});
}

}  // namespace

StateJournal::StateJournal(const std::string& path, std::uint64_t digest) : path_(path), digest_(digest) {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::string name = path + "." + std::to_string(i);
    if (auto found = read(name, digest); found && found->first >= number_) {
      number_ = found->first + 1;
      inherited_ = std::move(found->second);
    }
    files_[i] = open(name.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    require(files_[i] >= 0, "cannot write the journal " + name + ": " + std::strerror(errno));
  }
}

StateJournal::~StateJournal() {
  for (const int file : files_) close(file);
}

void StateJournal::write(std::int64_t session, SimTime at, std::span<const std::uint8_t> state) {
  Head head{0, digest_, number_, session, at, state.size()};
  head.check_sum = check_sum(head, state);
  const std::array<iovec, 2> parts{
      {{&head, sizeof head}, {const_cast<std::uint8_t*>(state.data()), state.size()}}};
  if (pwritev(files_[number_ % 2], parts.data(), parts.size(), 0) !=
      static_cast<ssize_t>(sizeof head + state.size()))
    throw std::runtime_error("the journal " + path_ + " could not be written whole (disk full?)");
  ++number_;
}

}  // namespace halocline::bus
